// SPDX-License-Identifier: MIT
// Points of the unit square onto triangles, discs, spheres and hemispheres, each with its density.
#pragma once

#include "lantern/core/math.h"

namespace lantern {

/// Barycentric weights of the second and third vertex, uniform over the triangle, continuous in u
/// and keeping strata compact. [Heitz 2019, A Low-Distortion Map Between Triangle and Square]
Vec2 square_to_triangle(Vec2 u);

/// Uniform on the unit disc, pdf 1/π. [Shirley & Chiu 1997]
Vec2 square_to_disc(Vec2 u);

/// Direction about +z with pdf_solid_angle cos θ / π.
Vec3 square_to_cosine_hemisphere(Vec2 u);

/// Direction with pdf_solid_angle 1/(4π).
Vec3 square_to_sphere(Vec2 u);

/// Direction within `cos_half_angle` of +z with pdf_solid_angle 1/(2π (1 - cos_half_angle)).
Vec3 square_to_cone(Vec2 u, float cos_half_angle);

}  // namespace lantern
