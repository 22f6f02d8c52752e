// SPDX-License-Identifier: MIT
#include "lantern/lights/walk.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/sampling/warp.h"
#include "lantern/scene/surface.h"

#include <algorithm>
#include <cmath>

namespace lantern {
namespace {

/// k-th member of the Kronecker sequence of an irrational number; equidistributed together with any
/// Halton sequence and with others whose irrationals are independent over the rationals.
double kronecker(std::size_t k, double irrational) {
  const double product = static_cast<double>(k) * irrational;
  return product - std::floor(product);
}

/// The survivors of a bounce are the first paths, counted from here on: without it they would
/// be those with the same low digits, hence the same strata of the emitters, in every pass.
std::size_t first_survivor(std::size_t pass, std::size_t paths) {
  const double u = kronecker(pass, std::cbrt(2.0));
  return std::min(static_cast<std::size_t>(u * static_cast<double>(paths)), paths - 1);
}

constexpr int kPlaceDimension = 0;  // and 1: the point on the emitters
constexpr int kWayDimension = 2;    // and 3: the first direction; then two for each bounce

/// The first point of the Halton sequence is 0 in every coordinate: a path from a corner, along an
/// edge and out of the room, as nothing says on which side of the edge it is. It is left out.
constexpr std::uint64_t kFirstPoint = 1;

/// Coordinates of one path of the point set.
class PathPoints {
 public:
  PathPoints(const WalkOptions& options, std::uint64_t index)
      : points_(options.points), jitter_(options.jitter), index_(index) {}

  /// Dimensions d and d + 1, jittered within the spacing of a generation of `size` points.
  Vec2 at(int dimension, std::size_t size) const {
    return {coordinate(dimension, size), coordinate(dimension + 1, size)};
  }

 private:
  float coordinate(int dimension, std::size_t size) const {
    const float u = points_.at(index_, dimension);
    if (!jitter_) return u;
    // A stream of its own: the plain sequence must not be correlated with what moves it.
    constexpr std::uint64_t kJitterStream = 0x6a69747465720000u;
    const float e = to_unit_float(
        hash(points_.seed ^ kJitterStream, index_, static_cast<std::uint64_t>(dimension)));
    const float moved = u + e / static_cast<float>(size);
    const float wrapped = moved < 1.0f ? moved : moved - 1.0f;
    return std::clamp(wrapped, 0.0f, 0x1.fffffep-1f);
  }

  const PointSet& points_;
  bool jitter_;
  std::uint64_t index_;
};

void append(VirtualLights& lights, LightKind kind, const Vec3& position, const Vec3& normal,
            const Rgb& flux, std::size_t path, std::size_t bounce, const Vec2& cone) {
  lights.kind.push_back(kind);
  lights.position.push_back(position);
  lights.normal.push_back(normal);
  lights.flux.push_back(flux);
  lights.path.push_back(static_cast<std::uint32_t>(path));
  lights.bounce.push_back(static_cast<std::uint32_t>(bounce));
  lights.cone.push_back(cone);
}

void append(VirtualLights& lights, const VirtualLights& more) {
  const auto join = [](auto& target, const auto& source) {
    target.insert(target.end(), source.begin(), source.end());
  };
  join(lights.kind, more.kind);
  join(lights.position, more.position);
  join(lights.normal, more.normal);
  join(lights.flux, more.flux);
  join(lights.path, more.path);
  join(lights.bounce, more.bounce);
  join(lights.cone, more.cone);
}

}  // namespace

Survival make_survival(std::size_t paths, float reflectivity, std::size_t pass) {
  const double p = static_cast<double>(reflectivity);
  Survival survival;
  std::size_t n = paths;
  double weight = 1.0 / static_cast<double>(paths);
  while (n > 0) {
    survival.paths.push_back(n);
    survival.weight.push_back(weight);
    const double expected = p * static_cast<double>(n);
    // Square roots of distinct primes are independent over the rationals: so are the bounces. That
    // of 2 spreads the choices from a pool.
    const auto bounce = static_cast<int>(survival.paths.size() - 1);
    const double u =
        bounce < kHaltonDimensions
            ? kronecker(pass, std::sqrt(static_cast<double>(halton_base(bounce))))
            : static_cast<double>(to_unit_float(hash(pass, static_cast<std::uint64_t>(bounce))));
    // p is a rounded number: 0.6 * 5 must not end below 3.
    constexpr double kRounding = 1e-6;
    const auto next = static_cast<std::size_t>(std::floor(expected + u + kRounding));
    const bool never_empty = expected + kRounding >= 1.0;
    if (next > 0) {
      weight *= never_empty ? static_cast<double>(n) / static_cast<double>(next) : 1.0 / p;
    }
    n = std::min(next, n);
  }
  return survival;
}

VirtualLights walk(const Scene& scene, const World& world, const Tracer& tracer,
                   const Emitters& emitters, const WalkOptions& options) {
  const std::size_t count = options.paths;
  const Survival survival = make_survival(count, options.reflectivity, options.pass);
  const std::size_t first = first_survivor(options.pass, count);
  const float scale = world.coordinate_scale();

  const auto trace_path = [&](std::size_t i, VirtualLights& lights) {
    const std::size_t rank = (i + count - first) % count;
    const PathPoints points(options, kFirstPoint +
                                         static_cast<std::uint64_t>(options.pass) * count +
                                         static_cast<std::uint64_t>(i));
    const auto generation = [&](std::size_t bounce) {
      return survival.paths[std::min(bounce, survival.paths.size() - 1)];
    };
    const PathStart start =
        emitters.start(points.at(kPlaceDimension, count), points.at(kWayDimension, generation(1)));
    if (!is_black(start.light_flux)) {
      append(lights, start.kind, start.position, start.normal,
             start.light_flux * static_cast<float>(survival.weight[0]), i, 0, start.cone);
    }
    Ray ray;
    ray.origin = start.kind == LightKind::kSurface ? off_surface(start.origin, start.normal, scale)
                                                   : start.origin;
    ray.direction = start.direction;
    Rgb flux = start.ray_flux;
    for (std::size_t bounce = 1;
         bounce < survival.paths.size() && rank < survival.paths[bounce] && !is_black(flux);
         ++bounce) {
      const Hit hit = tracer.closest(ray);
      if (!hit) return;
      const SurfacePoint point = surface_at(scene, world, hit.triangle, hit.uv);
      flux *= point.reflectance;
      if (is_black(flux)) return;
      const bool front = glm::dot(point.geometric_normal, ray.direction) < 0.0f;
      const Vec3 normal = front ? point.geometric_normal : -point.geometric_normal;
      append(lights, LightKind::kSurface, point.position, normal,
             flux * static_cast<float>(survival.weight[bounce]), i, bounce, Vec2(0.0f));
      const Vec2 u =
          points.at(kWayDimension + 2 * static_cast<int>(bounce), generation(bounce + 1));
      ray.origin = off_surface(point.position, normal, scale);
      ray.direction = Frame(normal).to_world(square_to_cosine_hemisphere(u));
    }
  };

  constexpr std::size_t kChunk = 64;
  std::vector<VirtualLights> chunks((count + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), 1, [&](std::size_t c) {
    for (std::size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) {
      trace_path(i, chunks[c]);
    }
  });
  VirtualLights lights;
  lights.paths = count;
  lights.reflectivity = options.reflectivity;
  for (const VirtualLights& chunk : chunks) append(lights, chunk);
  return lights;
}

float mean_squared_reflectance(const Scene& scene, const World& world) {
  double area_sum = 0.0;
  glm::dvec3 weighted(0.0);
  // A few places of each triangle stand for its texture: a threshold for a warning needs no more.
  constexpr int kGrid = 4;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const double area = world.area(t);
    area_sum += area;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const Vec2 u((static_cast<float>(i % kGrid) + 0.5f) / kGrid,
                   (static_cast<float>(i / kGrid) + 0.5f) / kGrid);
      const glm::dvec3 reflectance(surface_at(scene, world, t, square_to_triangle(u)).reflectance);
      weighted += area / (kGrid * kGrid) * reflectance * reflectance;
    }
  }
  return area_sum > 0.0
             ? static_cast<float>(glm::max(weighted.r, glm::max(weighted.g, weighted.b)) / area_sum)
             : 0.0f;
}

}  // namespace lantern
