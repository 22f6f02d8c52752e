// SPDX-License-Identifier: MIT
#include "lantern/path/path_tracer.h"

#include "lantern/core/hash.h"
#include "lantern/sampling/sobol.h"
#include "lantern/sampling/warp.h"
#include "lantern/scene/sky.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/eye.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace lantern {
namespace {

constexpr int kBlock = 4;  // pixels along the side of a packet
constexpr int kTile = 32;  // pixels along the side of what one task works on
static_assert(kBlock * kBlock == kPacket && kTile % kBlock == 0);

/// Paths of fewer bounces never end by roulette.
constexpr std::uint32_t kSureBounces = 2;

/// The share of the paths that goes on whatever they carry is below it: else they need not end.
constexpr float kMostSurvival = 0.95f;

/// A point that a path has reached, before anything is traced from it.
struct Vertex {
  Vec3 position;  // off the surface, on the side it is seen from
  Vec3 shading_normal;
  Vec3 geometric_normal;
  Rgb throughput;       // of the radiance that leaves it, times its reflectance
  std::uint32_t pixel;  // of the tile
  std::uint32_t bounces;
};

/// A ray on its way to the next vertex.
struct Extension {
  LitPoint start;
  Rgb throughput;
  std::uint32_t pixel;
  std::uint32_t bounces;
  float pdf_solid_angle;
};

/// Weight of a sample that its own technique finds with density `own`. [Veach & Guibas 1995]
float balance(float own, float other) { return own / (own + other); }

class TileTracer {
 public:
  TileTracer(const PathInput& input, const PathOptions& options, const ScrambledSobol& points,
             int x0, int y0, PathCounts& counts)
      : in_(input),
        options_(options),
        points_(points),
        scale_(input.world.coordinate_scale()),
        eye_(input.camera, options.width, options.height),
        x0_(x0),
        y0_(y0),
        columns_(std::min(kTile, options.width - x0)),
        rows_(std::min(kTile, options.height - y0)),
        counts_(counts) {}

  /// Stopped it leaves the tile black.
  void run(const StopFlag& stop, PathPass& pass) {
    const auto pixels = static_cast<std::size_t>(columns_ * rows_);
    std::vector<glm::dvec3> sum(pixels), squares(pixels);
    for (int sample = 0; sample < options_.samples; ++sample) {
      if (stop.load(std::memory_order_relaxed)) return;
      sample_ = static_cast<std::uint32_t>(sample);
      radiance_.assign(pixels, Rgb(0.0f));
      for (int y = 0; y < rows_; y += kBlock) {
        for (int x = 0; x < columns_; x += kBlock) see_block(x, y);
      }
      while (!next_.empty()) {
        current_.swap(next_);
        next_.clear();
        for (std::size_t i = 0; i < current_.size(); i += kPacket) {
          const std::size_t n = std::min<std::size_t>(kPacket, current_.size() - i);
          go_on(std::span(current_).subspan(i, n));
        }
      }
      for (std::size_t i = 0; i < pixels; ++i) {
        const glm::dvec3 r(radiance_[i]);
        sum[i] += r;
        squares[i] += r * r;
      }
    }
    const double share = 1.0 / options_.samples;
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) {
        const auto i = static_cast<std::size_t>(y * columns_ + x);
        pass.radiance.at(x0_ + x, y0_ + y) = Rgb(sum[i] * share);
        if (options_.squares) {
          pass.squared_radiance.at(x0_ + x, y0_ + y) = Rgb(squares[i] * share);
        }
      }
    }
  }

 private:
  /// Four random numbers for what happens between two vertices of the path through a pixel.
  Vec4 random(std::uint32_t pixel, std::uint32_t bounces) const {
    const auto x = static_cast<std::uint32_t>(x0_) + pixel % static_cast<std::uint32_t>(columns_);
    const auto y = static_cast<std::uint32_t>(y0_) + pixel / static_cast<std::uint32_t>(columns_);
    const std::uint64_t place = (std::uint64_t{y} << 32) | x;
    return points_.at(sample_, hash(hash(options_.seed, options_.pass, place), bounces));
  }

  void see_block(int bx, int by) {
    RayPacket rays{};
    LaneMask active{};
    std::uint32_t pixels[kPacket] = {};
    Vec2 light_points[kPacket];
    const Vec3 origin = eye_.origin();
    for (int i = 0; i < kPacket; ++i) {
      const int x = bx + i % kBlock, y = by + i / kBlock;
      if (x >= columns_ || y >= rows_) continue;
      pixels[i] = static_cast<std::uint32_t>(y * columns_ + x);
      const Vec4 u = random(pixels[i], 0);
      light_points[i] = Vec2(u);
      const Vec3 direction =
          eye_.direction(static_cast<float>(x0_ + x) + u.z, static_cast<float>(y0_ + y) + u.w);
      active.lane[i] = -1;
      rays.set(i, origin, direction, kInfinity);
      ++counts_.camera_rays;
    }
    Hit hits[kPacket];
    in_.tracer.closest(active, rays, hits);
    for (int i = 0; i < kPacket; ++i) {
      if (active.lane[i] == 0) continue;
      const Vec3 direction =
          glm::normalize(Vec3(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]));
      if (!hits[i]) {
        radiance_[pixels[i]] += sky_radiance(in_.scene, direction);
        continue;
      }
      arrive(hits[i], direction, {{}, Rgb(1.0f), pixels[i], 0, 0.0f}, light_points[i]);
    }
    end_vertices();
  }

  /// A path's ray has hit a surface: takes its emission and makes the next vertex.
  void arrive(const Hit& hit, const Vec3& direction, const Extension& ray, Vec2 light_point) {
    const bool front = glm::dot(in_.world.area_vector(hit.triangle), direction) < 0.0f;
    const Rgb emission = emission_at(in_.scene, in_.world, hit.triangle, hit.uv, front);
    if (!is_black(emission)) {
      float weight = 1.0f;
      if (ray.bounces > 0) {
        weight = balance(ray.pdf_solid_angle,
                         in_.lights.pdf_of_hit(ray.start, hit.triangle, direction, hit.distance));
      }
      radiance_[ray.pixel] += ray.throughput * emission * weight;
    }
    const SurfacePoint surface = surface_at(in_.scene, in_.world, hit.triangle, hit.uv);
    const Rgb throughput = ray.throughput * surface.reflectance;
    if (is_black(throughput)) return;
    const float side = front ? 1.0f : -1.0f;
    const Vec3 geometric = surface.geometric_normal * side;
    // Light paths know no shading normals but where the eye sees them: then all methods agree.
    const Vec3 shading = ray.bounces == 0 ? surface.shading_normal * side : geometric;
    pending_.push_back({off_surface(surface.position, geometric, scale_), shading, geometric,
                        throughput, ray.pixel, ray.bounces});
    light_points_.push_back(light_point);
  }

  /// Light that comes straight from an emitter to the vertices just reached.
  void end_vertices() {
    for (std::size_t first = 0; first < pending_.size(); first += kPacket) {
      const std::size_t n = std::min<std::size_t>(kPacket, pending_.size() - first);
      RayPacket rays{};
      LaneMask active{};
      Rgb lit[kPacket];
      for (std::size_t i = 0; i < n; ++i) {
        const Vertex& v = pending_[first + i];
        const LightSample light =
            in_.lights.sample({v.position, v.shading_normal}, light_points_[first + i]);
        const float cos_at_point = glm::dot(v.shading_normal, light.direction);
        if (!(cos_at_point > 0.0f) || !(glm::dot(v.geometric_normal, light.direction) > 0.0f) ||
            is_black(light.radiance)) {
          continue;
        }
        const float pdf_of_ray = cos_at_point * kInvPi;
        const float weight =
            light.pdf_solid_angle > 0.0f ? balance(light.pdf_solid_angle, pdf_of_ray) : 1.0f;
        lit[i] = v.throughput * light.radiance * (pdf_of_ray * weight);
        active.lane[i] = -1;
        rays.set(static_cast<int>(i), v.position, light.to_light, light.far);
        ++counts_.shadow_rays;
      }
      in_.tracer.occluded(active, rays);
      for (std::size_t i = 0; i < n; ++i) {
        if (active.lane[i] != 0 && rays.far[i] >= 0.0f) {
          radiance_[pending_[first + i].pixel] += lit[i];
        }
      }
    }
    next_.insert(next_.end(), pending_.begin(), pending_.end());
    pending_.clear();
    light_points_.clear();
  }

  /// Traces a cosine-distributed ray from up to sixteen vertices to the next ones.
  void go_on(std::span<const Vertex> vertices) {
    RayPacket rays{};
    LaneMask active{};
    Extension extensions[kPacket];
    Vec2 light_points[kPacket];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vertex& v = vertices[i];
      const std::uint32_t bounces = v.bounces + 1;
      Rgb throughput = v.throughput;
      if (bounces > kSureBounces) {
        const float survival = std::min(kMostSurvival, max_component(throughput));
        if (roulette(v) >= survival) continue;
        throughput /= survival;
      }
      const Vec4 u = random(v.pixel, bounces);
      const Vec3 local = square_to_cosine_hemisphere(Vec2(u));
      const Vec3 direction = Frame(v.shading_normal).to_world(local);
      if (!(glm::dot(direction, v.geometric_normal) > 0.0f)) continue;
      light_points[i] = Vec2(u.z, u.w);
      extensions[i] = {
          {v.position, v.shading_normal}, throughput, v.pixel, bounces, local.z * kInvPi};
      active.lane[i] = -1;
      rays.set(static_cast<int>(i), v.position, direction, kInfinity);
      ++counts_.bounce_rays;
    }
    Hit hits[kPacket];
    in_.tracer.closest(active, rays, hits);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (active.lane[i] == 0) continue;
      const Vec3 direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      const Extension& ray = extensions[i];
      if (!hits[i]) {
        const float weight =
            balance(ray.pdf_solid_angle, in_.lights.pdf_of_sky(ray.start, direction));
        radiance_[ray.pixel] += ray.throughput * sky_radiance(in_.scene, direction) * weight;
        continue;
      }
      arrive(hits[i], direction, ray, light_points[i]);
    }
    end_vertices();
  }

  float roulette(const Vertex& v) const {
    constexpr std::uint64_t kRouletteStream = 0x726f756c65747465u;
    return to_unit_float(
        hash(hash(options_.seed ^ kRouletteStream, options_.pass, sample_),
             (std::uint64_t{v.pixel} << 32) | v.bounces,
             (static_cast<std::uint64_t>(x0_) << 32) | static_cast<std::uint64_t>(y0_)));
  }

  const PathInput& in_;
  const PathOptions& options_;
  const ScrambledSobol& points_;
  float scale_;
  Eye eye_;
  int x0_, y0_, columns_, rows_;
  PathCounts& counts_;
  std::uint32_t sample_ = 0;
  std::vector<Rgb> radiance_;  // of the sample under way, by pixels of the tile
  std::vector<Vertex> pending_, current_, next_;
  std::vector<Vec2> light_points_;
};

}  // namespace

PathPass trace_paths(const PathInput& input, const PathOptions& options, PathCounts& counts,
                     const StopFlag& stop, const std::function<void(std::size_t)>& tile_done) {
  PathPass pass{Image(options.width, options.height), Image()};
  if (options.squares) pass.squared_radiance = pass.radiance;
  const ScrambledSobol points(static_cast<std::uint32_t>(options.samples));
  const int columns = (options.width + kTile - 1) / kTile;
  const int rows = (options.height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<PathCounts> tile_counts(tiles);
  parallel_for(tiles, 1, [&](std::size_t i) {
    const int x0 = static_cast<int>(i % static_cast<std::size_t>(columns)) * kTile;
    const int y0 = static_cast<int>(i / static_cast<std::size_t>(columns)) * kTile;
    TileTracer(input, options, points, x0, y0, tile_counts[i]).run(stop, pass);
    if (tile_done) {
      tile_done(static_cast<std::size_t>(std::min(kTile, options.width - x0)) *
                static_cast<std::size_t>(std::min(kTile, options.height - y0)));
    }
  });
  for (const PathCounts& c : tile_counts) {
    counts.camera_rays += c.camera_rays;
    counts.bounce_rays += c.bounce_rays;
    counts.shadow_rays += c.shadow_rays;
  }
  return pass;
}

}  // namespace lantern
