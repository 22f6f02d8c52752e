// SPDX-License-Identifier: MIT
#include "lantern/radiosity/element_points.h"

#include "lantern/core/parallel.h"
#include "lantern/radiosity/exposure.h"
#include "lantern/radiosity/random.h"

namespace lantern {
namespace {

constexpr int kAlongEdge = 4;
static_assert(kAlongEdge * kAlongEdge == ElementPoints::kPoints);

/// Weights of the second and third corner, at random in the k-th of sixteen equal triangles.
Vec2 in_part(std::size_t k, Random& random) {
  int row = 0, place = static_cast<int>(k);
  while (place >= 2 * (kAlongEdge - row) - 1) {
    place -= 2 * (kAlongEdge - row) - 1;
    ++row;
  }
  const Vec2 within = random.in_triangle();
  const Vec2 corner(static_cast<float>(place / 2), static_cast<float>(row));
  const bool upright = place % 2 == 0;
  return (corner + (upright ? within : 1.0f - within)) / static_cast<float>(kAlongEdge);
}

}  // namespace

ElementPoints::ElementPoints(const World& world, const Tracer& tracer, const Patches& patches)
    : exposed_(patches.elements() * kPoints), whole_(patches.elements() * kPoints) {
  constexpr std::size_t kGrain = 64;
  // A patch with a hundredth of it exposed still finds most of its points.
  constexpr int kTries = 200;
  const float scale = world.coordinate_scale();
  parallel_for(patches.elements(), kGrain, [&](std::size_t e) {
    const std::uint32_t patch = patches.patch[e];
    const Vec3 normal(patches.element_normal(e));
    const Vec3 a(patches.mesh.corner(patch, 0)), b(patches.mesh.corner(patch, 1)),
        c(patches.mesh.corner(patch, 2));
    const auto point = [&](Vec2 w) { return a * (1.0f - w.x - w.y) + b * w.x + c * w.y; };
    const bool partly = patches.exposed[e] > 0.0 && patches.exposed[e] < 1.0;
    for (std::size_t k = 0; k < kPoints; ++k) {
      Random random(hash(e, k));
      Vec3 position = point(in_part(k, random));
      whole_[e * kPoints + k] = off_surface(position, normal, scale);
      for (int i = 0; partly && i < kTries &&
                      is_covered(world, patches.lit, tracer, position, normal, hash(e, k));
           ++i) {
        position = point(random.in_triangle());
      }
      exposed_[e * kPoints + k] = off_surface(position, normal, scale);
    }
  });
}

}  // namespace lantern
