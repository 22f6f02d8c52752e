// SPDX-License-Identifier: MIT
// Independent random numbers out of a key, and the points and directions made of them.
#pragma once

#include "lantern/core/hash.h"
#include "lantern/core/math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lantern {

/// The unit square to directions about +z with density cos θ / π.
inline Vec3 cosine_direction(Vec2 u) {
  const float r = std::sqrt(u.x), angle = 2.0f * kPi * u.y;
  return {r * std::cos(angle), r * std::sin(angle), std::sqrt(1.0f - u.x)};
}

/// A counter that is hashed with its key: the same key, the same numbers.
class Random {
 public:
  explicit Random(std::uint64_t key) : key_(hash(key)) {}

  /// In [0, 1).
  float unit() { return to_unit_float(hash(key_ + ++count_)); }
  /// Below `size`.
  std::size_t index(std::size_t size) {
    return std::min(size - 1, static_cast<std::size_t>(unit() * static_cast<float>(size)));
  }
  /// Barycentric weights of the second and third vertex, uniform.
  Vec2 in_triangle() {
    const float x = unit(), y = unit();
    const Vec2 u(x, y);
    return u.x + u.y < 1.0f ? u : 1.0f - u;
  }
  /// About +z, with density cos θ / π.
  Vec3 cosine_direction() {
    const float x = unit(), y = unit();
    return lantern::cosine_direction(Vec2(x, y));
  }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace lantern
