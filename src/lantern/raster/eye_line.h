// SPDX-License-Identifier: MIT
// The way from a light to the eye among triangles of common vertices, without cracks: where it
// meets an edge it goes through one of the two triangles beside it.
#pragma once

#include "lantern/raster/volume_edge.h"

#include <cstdint>
#include <span>

namespace lantern {

class EyeLine {
 public:
  /// Keeps a reference to the vertices.
  EyeLine(std::span<const Vec3> vertices, const LightPoint& light, const Vec3& eye)
      : vertices_(vertices), light_(light), eye_(eye) {}

  /// Whether the line, on both sides of the eye, meets the sphere, or nearly.
  bool meets(const Vec3& centre, float radius) const;
  /// 1: the way goes through the triangle from its front to its back; -1: the other way; 0: not at
  /// all. Light and eye must be on different sides of its plane.
  int crossing(const uvec3& triangle) const;
  /// Whether light and eye are on different sides of the triangle's plane.
  bool is_parted_by(const uvec3& triangle) const;

 private:
  int side_of(std::uint32_t from, std::uint32_t to) const;

  std::span<const Vec3> vertices_;
  LightPoint light_;
  Vec3 eye_;
};

}  // namespace lantern
