// SPDX-License-Identifier: MIT
// The surface at a point of a triangle: where it is, which way it faces, what it reflects and
// emits.
#pragma once

#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

namespace lantern {

struct SurfacePoint {
  Vec3 position;
  Vec3 geometric_normal;  // unit, of the triangle's front
  Vec3 shading_normal;    // unit, on the same side as the geometric one
  Rgb reflectance;        // in [0, 1]
};

/// `uv` are the barycentric weights of the triangle's second and third vertex, here and below.
SurfacePoint surface_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv);

/// Radiance that leaves the point on the side of the front (`from_front`) or of the back.
Rgb emission_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv,
                bool from_front);

/// Whether the point is a hole (alpha mask): rays of all kinds go through.
bool is_hole(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv);

/// Area-weighted mean over all surfaces and the three channels: the share p of the walk [Keller
/// 1997].
float mean_reflectivity(const Scene& scene, const World& world);

}  // namespace lantern
