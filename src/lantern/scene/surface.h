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

/// Whether rays may pass through surfaces of this material.
inline bool has_holes(const Material& material) { return material.alpha_cutoff || material.blend; }

/// Of a blended material whose surfaces stop the same share of the rays everywhere, that share.
std::optional<float> even_coverage(const Material& material);

/// Share of the rays that the surface stops, in [0, 1]; 0 or 1 but for blended materials.
float coverage_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv);

/// Whether this ray passes through the surface at the point. Where coverage is partial a hash of
/// the ray decides: every tracer says the same of the same ray.
bool is_hole(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv,
             const Vec3& origin, const Vec3& direction);

/// Area-weighted mean over all surfaces and the three channels: the share p of the walk [Keller
/// 1997].
float mean_reflectivity(const Scene& scene, const World& world);

}  // namespace lantern
