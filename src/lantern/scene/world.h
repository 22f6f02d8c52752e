// SPDX-License-Identifier: MIT
// Every triangle of every instance in world space, in one set of arrays: what is traced, what emits
// and what reflects. A mirroring transform keeps each triangle's front its front.
#pragma once

#include "lantern/scene/scene.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lantern {

/// Whether a triangle with this area vector has a length and a direction that float can hold.
inline bool has_area(const Vec3& area_vector) {
  const float square = glm::dot(area_vector, area_vector);
  return square > std::numeric_limits<float>::min() && std::isfinite(square);
}

struct World {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;    // empty or per vertex; zero: the triangle's own
  std::vector<Vec2> texcoords;  // empty or per vertex
  std::vector<Vec4> colours;    // empty or per vertex
  std::vector<uvec3> triangles;
  std::vector<MaterialId> materials;  // per triangle
  Bounds bounds;                      // of the triangles

  std::size_t size() const { return triangles.size(); }

  /// The largest coordinate, which the rounding of positions is relative to.
  float coordinate_scale() const {
    if (bounds.empty()) return 0.0f;
    const Vec3 extreme = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return std::max(extreme.x, std::max(extreme.y, extreme.z));
  }

  /// cross(b - a, c - a): twice the area along the front's normal.
  Vec3 area_vector(std::uint32_t triangle) const {
    const uvec3 v = triangles[triangle];
    const Vec3 a = positions[v.x];
    return glm::cross(positions[v.y] - a, positions[v.z] - a);
  }
  float area(std::uint32_t triangle) const { return 0.5f * glm::length(area_vector(triangle)); }
};

/// `scene` must be valid (see validate.h).
World make_world(const Scene& scene);

}  // namespace lantern
