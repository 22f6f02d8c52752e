// SPDX-License-Identifier: MIT
// Closest hits and occlusion in a World. Two implementations that share nothing but this: Embree
// and brute force. Holes of alpha-masked materials let every ray through.
#pragma once

#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <memory>

namespace lantern {

struct Ray {
  Vec3 origin{0.0f};
  Vec3 direction{0.0f, 0.0f, 1.0f};  // need not be unit length; distances are in its lengths
  float near = 0.0f;
  float far = kInfinity;
};

struct Hit {
  float distance = kInfinity;  // in lengths of the ray's direction
  std::uint32_t triangle = 0;
  Vec2 uv{0.0f};  // barycentric weights of the triangle's second and third vertex

  explicit operator bool() const { return distance < kInfinity; }
};

/// Sixteen rays as structure of arrays, the layout Embree takes.
inline constexpr int kPacket = 16;
struct alignas(64) RayPacket {
  float origin_x[kPacket], origin_y[kPacket], origin_z[kPacket], near[kPacket];
  float direction_x[kPacket], direction_y[kPacket], direction_z[kPacket], time[kPacket];
  float far[kPacket];
  std::uint32_t mask[kPacket], id[kPacket], flags[kPacket];

  /// Puts a ray that starts at `origin` into lane i.
  void set(int i, const Vec3& origin, const Vec3& direction, float to = kInfinity) {
    origin_x[i] = origin.x;
    origin_y[i] = origin.y;
    origin_z[i] = origin.z;
    near[i] = 0.0f;
    direction_x[i] = direction.x;
    direction_y[i] = direction.y;
    direction_z[i] = direction.z;
    time[i] = 0.0f;
    far[i] = to;
    mask[i] = ~0u;
    id[i] = static_cast<std::uint32_t>(i);
    flags[i] = 0;
  }
};
/// 0: the lane is idle; -1: it holds a ray.
struct alignas(64) LaneMask {
  std::int32_t lane[kPacket];
};

/// A point a hair off its surface, on the side of `normal`, from where rays start and where shadow
/// rays end without meeting the surface itself. `scale` is the largest coordinate of the scene:
/// float positions err by its rounding, not by their own. See World::coordinate_scale().
inline Vec3 off_surface(const Vec3& position, const Vec3& normal, float scale) {
  constexpr float kOffset = 0x1p-18f;  // 32 roundings of the largest coordinate
  return position + normal * (kOffset * scale);
}

class Tracer {
 public:
  virtual ~Tracer() = default;

  virtual Hit closest(const Ray& ray) const = 0;
  virtual bool occluded(const Ray& ray) const = 0;
  /// `far` of the active lanes whose ray is blocked becomes minus infinity; the rest stays.
  virtual void occluded(const LaneMask& active, RayPacket& packet) const = 0;
  /// Closest hits of the active lanes; idle lanes come back empty.
  virtual void closest(const LaneMask& active, RayPacket& packet, Hit* hits) const = 0;
};

}  // namespace lantern
