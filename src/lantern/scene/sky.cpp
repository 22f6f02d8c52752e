// SPDX-License-Identifier: MIT
#include "lantern/scene/sky.h"

#include "lantern/scene/texture.h"

#include <algorithm>
#include <cmath>

namespace lantern {

Vec2 to_lat_long(const Vec3& direction) {
  const float u = std::atan2(direction.x, -direction.z) * (0.5f * kInvPi);
  const float v = std::acos(std::clamp(direction.y, -1.0f, 1.0f)) * kInvPi;
  return {u < 0.0f ? u + 1.0f : u, v};
}

Vec3 from_lat_long(const Vec2& uv) {
  const float azimuth = 2.0f * kPi * uv.x, polar = kPi * uv.y;
  const float s = std::sin(polar);
  return {s * std::sin(azimuth), std::cos(polar), -s * std::cos(azimuth)};
}

float lat_long_solid_angle(const Vec2& uv) {
  constexpr float kPole = 1e-6f;
  return 2.0f * kPi * kPi * std::max(kPole, std::sin(kPi * uv.y));
}

Rgb sky_radiance(const Scene& scene, const Vec3& towards) {
  if (!scene.sky) return Rgb(0.0f);
  if (!scene.sky->texture) return scene.sky->radiance;
  const Texture& texture = scene.textures[index(*scene.sky->texture)];
  return scene.sky->radiance *
         glm::max(Rgb(sample(texture, to_lat_long(glm::normalize(towards)))), Rgb(0.0f));
}

}  // namespace lantern
