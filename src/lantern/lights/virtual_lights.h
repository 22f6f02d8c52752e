// SPDX-License-Identifier: MIT
// The contract between whoever makes lights and whoever renders from them: structure of arrays,
// normalised (a light's share of the picture needs no factor from the reader), sorted by path, then
// bounce. [Keller 1997]
#pragma once

#include "lantern/core/math.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

/// How a light shines. With flux Φ, distance d and the cosine at the light cos_y:
enum class LightKind : std::uint8_t {
  kSurface,      // Lambertian point: intensity Φ/π · max(0, cos_y), nothing behind its surface
  kPoint,        // intensity Φ/(4π) in every direction
  kSpot,         // intensity Φ / spot_solid_angle() · spot_falloff(cos_y)
  kDirectional,  // from infinity along `normal`: `flux` is irradiance in W/m² on a facing surface
};

struct VirtualLights {
  std::size_t paths = 0;      // paths started
  float reflectivity = 0.0f;  // the share p of paths that survived each bounce

  std::vector<Vec3> position;  // unused for directional lights
  std::vector<Vec3> normal;    // unit: surface normal, spot axis or direction of travel
  std::vector<Rgb> flux;       // W (directional: W/m²), normalisation included
  std::vector<std::uint32_t> path;
  std::vector<std::uint32_t> bounce;  // 0: where the path starts
  std::vector<LightKind> kind;
  std::vector<Vec2> cone;  // spot: cosines of inner and outer half angle; else 0

  std::size_t size() const { return position.size(); }
};

/// Share of the axis' intensity at an angle of cosine `cos_y` from it, for cone = (cos inner, cos
/// outer): the square of a ramp in the cosine, as glTF's KHR_lights_punctual suggests.
inline float spot_falloff(float cos_y, const Vec2& cone) {
  const float ramp = (cos_y - cone.y) / std::max(cone.x - cone.y, 1e-4f);
  const float clamped = std::min(std::max(ramp, 0.0f), 1.0f);
  return clamped * clamped;
}

/// Flux of a spot light over its intensity on the axis: the integral of the falloff over the
/// sphere.
inline float spot_solid_angle(const Vec2& cone) {
  return 2.0f * kPi * ((1.0f - cone.x) + (cone.x - cone.y) * (1.0f / 3.0f));
}

}  // namespace lantern
