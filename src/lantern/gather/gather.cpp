// SPDX-License-Identifier: MIT
#include "lantern/gather/gather.h"

#include "lantern/core/hash.h"
#include "lantern/gather/term_bound.h"
#include "lantern/sampling/kronecker.h"
#include "lantern/sampling/warp.h"
#include "lantern/scene/sky.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/eye.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

namespace lantern {
namespace {

constexpr int kBlock = 4;  // pixels along the side of a packet
constexpr int kTile = 32;  // pixels along the side of what one task works on
static_assert(kBlock * kBlock == kPacket && kTile % kBlock == 0);

/// Cube roots of 3 and 5, independent of the former over the rationals, so that what is traced is
/// not tied to where in the pixel it starts.
constexpr glm::dvec2 kCompensationSequence(1.44224957030740838232, 1.70997594667669698935);

/// A point that light is gathered at, on its way to a pixel.
struct ShadingPoint {
  Vec3 position;  // off the surface, on the side it is seen from
  Vec3 shading_normal;
  Vec3 geometric_normal;
  Rgb throughput;  // of the radiance that leaves it, times its reflectance
  std::uint32_t pixel;
  std::uint64_t sample;  // of the pixel, counted over passes
  std::uint32_t depth;   // how often the bound was compensated to get here
};

class TileGatherer {
 public:
  TileGatherer(const GatherInput& input, const GatherLights& lights, const GatherOptions& options,
               const TermBound& bound, GatherCounts& counts)
      : in_(input),
        lights_(lights),
        options_(options),
        bound_(bound),
        scale_(input.world.coordinate_scale()),
        eye_(input.camera, options.width, options.height),
        counts_(counts) {}

  void run(int x0, int y0, Image& image) {
    const int x1 = std::min(x0 + kTile, options_.width);
    const int y1 = std::min(y0 + kTile, options_.height);
    for (int sample = 0; sample < options_.samples; ++sample) {
      for (int y = y0; y < y1; y += kBlock) {
        for (int x = x0; x < x1; x += kBlock) see_block(x, y, sample, image);
      }
    }
    // What the bound took comes back from points that are hit close by, and what it took there from
    // further ones, until none is left.
    while (!next_.empty()) {
      current_.swap(next_);
      next_.clear();
      for (std::size_t i = 0; i < current_.size(); i += kPacket) {
        const std::size_t n = std::min<std::size_t>(kPacket, current_.size() - i);
        gather_at(std::span(current_).subspan(i, n), image);
      }
    }
  }

 private:
  void see_block(int x0, int y0, int sample, Image& image) {
    const auto n =
        static_cast<std::uint64_t>(options_.pass) * static_cast<std::uint64_t>(options_.samples) +
        static_cast<std::uint64_t>(sample);
    const Vec2 offset = place_in_pixel(n);
    RayPacket rays{};
    LaneMask active{};
    std::uint32_t pixels[kPacket];
    const Vec3 origin = eye_.origin();
    for (int i = 0; i < kPacket; ++i) {
      const int x = x0 + i % kBlock, y = y0 + i / kBlock;
      const Vec3 direction =
          eye_.direction(static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
      const bool inside = x < options_.width && y < options_.height;
      active.lane[i] = inside ? -1 : 0;
      pixels[i] = inside ? static_cast<std::uint32_t>(y * options_.width + x) : 0;
      rays.set(i, origin, direction);
      counts_.camera_rays += inside ? 1 : 0;
    }
    Hit hits[kPacket];
    in_.tracer.closest(active, rays, hits);

    ShadingPoint points[kPacket];
    std::size_t count = 0;
    const float share = 1.0f / static_cast<float>(options_.samples);
    for (int i = 0; i < kPacket; ++i) {
      if (active.lane[i] == 0) continue;
      const Vec3 direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      Rgb& pixel = image.pixels[pixels[i]];
      if (!hits[i]) {
        pixel += share * sky_radiance(in_.scene, direction);
        continue;
      }
      const bool front = seen_from_front(hits[i], direction);
      pixel += share * emission_at(in_.scene, in_.world, hits[i].triangle, hits[i].uv, front);
      const SurfacePoint surface = surface_at(in_.scene, in_.world, hits[i].triangle, hits[i].uv);
      if (is_black(surface.reflectance)) continue;
      points[count++] = shading_point(surface, front, surface.shading_normal,
                                      share * surface.reflectance, pixels[i], n, 0);
    }
    gather_at(std::span(points, count), image);
  }

  bool seen_from_front(const Hit& hit, const Vec3& direction) const {
    return glm::dot(in_.world.area_vector(hit.triangle), direction) < 0.0f;
  }

  ShadingPoint shading_point(const SurfacePoint& surface, bool front, const Vec3& shading_normal,
                             const Rgb& throughput, std::uint32_t pixel, std::uint64_t sample,
                             std::uint32_t depth) const {
    const float side = front ? 1.0f : -1.0f;
    const Vec3 geometric = surface.geometric_normal * side;
    return {off_surface(surface.position, geometric, scale_),
            shading_normal * side,
            geometric,
            throughput,
            pixel,
            sample,
            depth};
  }

  /// Up to sixteen points against all lights, into their pixels.
  void gather_at(std::span<const ShadingPoint> points, Image& image) {
    if (points.empty()) return;
    assert(points.size() <= kPacket);
    ShadingPacket packet{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      packet.set(i, points[i].position, points[i].shading_normal, points[i].geometric_normal);
    }
    IrradiancePacket irradiance;
    counts_.shadow_rays += gather_irradiance(lights_, packet, in_.tracer, bound_.reflected(),
                                             options_.shadow_rays, irradiance);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Rgb e(irradiance.r[i], irradiance.g[i], irradiance.b[i]);
      image.pixels[points[i].pixel] += points[i].throughput * e * kInvPi;
    }
    if (options_.compensate && !bound_.none()) trace_residual(points, image);
  }

  /// Random numbers of one sample at one depth, for what no sequence is spread over.
  std::uint64_t random_bits(const ShadingPoint& p) const {
    return hash(hash(options_.seed, p.pixel, p.depth), p.sample);
  }

  /// Where the compensating ray goes: over the samples of a pixel the first rays are well spread;
  /// the few that follow are not tied to them.
  Vec2 compensation_point(const ShadingPoint& p) const {
    const std::uint64_t key = p.depth == 0 ? hash(options_.seed, p.pixel) : random_bits(p);
    const Vec2 shift(to_unit_float(key), to_unit_float(hash(key)));
    return p.depth == 0 ? kronecker(p.sample, kCompensationSequence, shift) : shift;
  }

  /// One cosine-distributed ray from each point: what it hits sends (1 - bound/G)+ of its radiance,
  /// which is just what min(G, bound) left out. [Kollig & Keller 2004, equation 6]
  void trace_residual(std::span<const ShadingPoint> points, Image& image) {
    RayPacket rays{};
    LaneMask active{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ShadingPoint& p = points[i];
      const Vec3 local = square_to_cosine_hemisphere(compensation_point(p));
      const Vec3 direction = Frame(p.shading_normal).to_world(local);
      active.lane[i] = glm::dot(direction, p.geometric_normal) > 0.0f ? -1 : 0;
      counts_.compensation_rays += active.lane[i] != 0 ? 1 : 0;
      // Further than this the bound takes nothing.
      rays.set(static_cast<int>(i), p.position, direction, 1.0f / std::sqrt(bound_.reflected()));
    }
    Hit hits[kPacket];
    in_.tracer.closest(active, rays, hits);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (active.lane[i] == 0 || !hits[i]) continue;
      const ShadingPoint& p = points[i];
      const Vec3 direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      const SurfacePoint surface = surface_at(in_.scene, in_.world, hits[i].triangle, hits[i].uv);
      const float cos_at_hit = std::abs(glm::dot(surface.geometric_normal, direction));
      const float cos_at_point = glm::dot(p.shading_normal, direction);
      const float geometry_term = cos_at_point * cos_at_hit / (hits[i].distance * hits[i].distance);
      const auto left_out = [&](float bound) {
        return std::max(0.0f, 1.0f - bound / geometry_term);
      };
      const bool front = glm::dot(surface.geometric_normal, direction) < 0.0f;
      image.pixels[p.pixel] +=
          p.throughput * left_out(bound_.emitted(hits[i].triangle)) *
          emission_at(in_.scene, in_.world, hits[i].triangle, hits[i].uv, front);
      const float reflected = left_out(bound_.reflected());
      Rgb throughput = p.throughput * surface.reflectance * reflected;
      if (is_black(throughput)) continue;
      // In a crevice between bright walls the chain of close hits is long: roulette ends it.
      constexpr std::uint32_t kSureDepth = 3;
      if (p.depth >= kSureDepth) {
        constexpr float kMostlyGoesOn = 0.9f;
        const float goes_on =
            std::min(kMostlyGoesOn, max_component(surface.reflectance) * reflected);
        if (to_unit_float(hash(random_bits(p), 1)) >= goes_on) continue;
        throughput /= goes_on;
      }
      // Light paths know no shading normals, so their lights' other ends must not either.
      next_.push_back(shading_point(surface, front, surface.geometric_normal, throughput, p.pixel,
                                    p.sample, p.depth + 1));
    }
  }

  const GatherInput& in_;
  const GatherLights& lights_;
  const GatherOptions& options_;
  const TermBound& bound_;
  float scale_;
  Eye eye_;
  GatherCounts& counts_;
  std::vector<ShadingPoint> current_, next_;
};

}  // namespace

Image gather(const GatherInput& input, const VirtualLights& lights, const GatherOptions& options,
             GatherCounts& counts, const StopFlag& stop,
             const std::function<void(std::size_t)>& tile_done) {
  Image image(options.width, options.height);
  const TermBound bound(input.scene, input.world, input.emitters, lights, options.bound);
  const GatherLights ready(lights, input.world.coordinate_scale(),
                           bound.of_lights(lights, input.tracer));
  const int columns = (options.width + kTile - 1) / kTile;
  const int rows = (options.height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<GatherCounts> tile_counts(tiles);
  parallel_for(tiles, 1, [&](std::size_t i) {
    if (stop.load(std::memory_order_relaxed)) return;
    const int x0 = static_cast<int>(i % static_cast<std::size_t>(columns)) * kTile;
    const int y0 = static_cast<int>(i / static_cast<std::size_t>(columns)) * kTile;
    TileGatherer(input, ready, options, bound, tile_counts[i]).run(x0, y0, image);
    if (tile_done) {
      tile_done(static_cast<std::size_t>(std::min(kTile, options.width - x0)) *
                static_cast<std::size_t>(std::min(kTile, options.height - y0)));
    }
  });
  for (const GatherCounts& c : tile_counts) {
    counts.camera_rays += c.camera_rays;
    counts.shadow_rays += c.shadow_rays;
    counts.compensation_rays += c.compensation_rays;
  }
  return image;
}

}  // namespace lantern
