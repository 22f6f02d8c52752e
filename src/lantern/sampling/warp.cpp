// SPDX-License-Identifier: MIT
#include "lantern/sampling/warp.h"

#include <cmath>

namespace lantern {
namespace {

constexpr float kTwoPi = 2.0f * kPi;

Vec3 direction(float sin_theta, float cos_theta, float phi) {
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

}  // namespace

Vec2 square_to_triangle(Vec2 u) {
  if (u.y > u.x) {
    const float half = 0.5f * u.x;
    return {half, u.y - half};
  }
  const float half = 0.5f * u.y;
  return {u.x - half, half};
}

Vec2 square_to_disc(Vec2 u) {
  const Vec2 p = 2.0f * u - 1.0f;
  if (p.x == 0.0f && p.y == 0.0f) return Vec2(0.0f);
  const bool x_leads = std::abs(p.x) > std::abs(p.y);
  const float radius = x_leads ? p.x : p.y;
  const float phi = x_leads ? 0.25f * kPi * (p.y / p.x) : 0.5f * kPi - 0.25f * kPi * (p.x / p.y);
  return radius * Vec2(std::cos(phi), std::sin(phi));
}

// In polar coordinates rather than over the disc: there the square's whole border, with the first
// point of the Halton sequence on it, would meet the horizon; here u < 1 keeps z at 2^-12 or more.
Vec3 square_to_cosine_hemisphere(Vec2 u) {
  return direction(std::sqrt(u.x), std::sqrt(1.0f - u.x), kTwoPi * u.y);
}

Vec3 square_to_sphere(Vec2 u) {
  return direction(2.0f * std::sqrt(u.x * (1.0f - u.x)), 1.0f - 2.0f * u.x, kTwoPi * u.y);
}

Vec3 square_to_cone(Vec2 u, float cos_half_angle) {
  const float below_top = u.x * (1.0f - cos_half_angle);
  // 1 - cos² without the cancellation that narrow cones would feel.
  const float sin_theta = std::sqrt(below_top * (2.0f - below_top));
  return direction(sin_theta, 1.0f - below_top, kTwoPi * u.y);
}

}  // namespace lantern
