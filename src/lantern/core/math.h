// SPDX-License-Identifier: MIT
// Vectors, matrices and colours of the whole program (glm), bounds, and the few helpers glm lacks.
// Colours are linear Rec. 709 RGB. Lengths are metres, angles radians unless a name says otherwise.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <limits>

namespace lantern {

using glm::uvec3;
using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Quat = glm::quat;
using Rgb = glm::vec3;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 1.0f / kPi;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline float max_component(const Rgb& c) { return std::max(c.r, std::max(c.g, c.b)); }
inline float mean_component(const Rgb& c) { return (c.r + c.g + c.b) * (1.0f / 3.0f); }
inline bool is_black(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }

/// Relative luminance of linear Rec. 709 RGB (ITU-R BT.709, item 3.2).
inline float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// Axis-aligned box; empty until a point is added.
struct Bounds {
  Vec3 low{kInfinity};
  Vec3 high{-kInfinity};

  bool empty() const { return low.x > high.x; }
  void add(const Vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  Vec3 centre() const { return 0.5f * (low + high); }
  /// Radius of the sphere around the box, the scene's unit of length for every relative threshold.
  float radius() const { return empty() ? 0.0f : 0.5f * glm::length(high - low); }
};

/// Orthonormal frame with `normal` as z; the tangents are continuous but for normal.z = 0's sign
/// change. [Duff et al. 2017, Building an Orthonormal Basis, Revisited]
struct Frame {
  Vec3 tangent, bitangent, normal;

  explicit Frame(const Vec3& n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = Vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    bitangent = Vec3(b, sign + n.y * n.y * a, -n.y);
  }
  Vec3 to_world(const Vec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
};

}  // namespace lantern
