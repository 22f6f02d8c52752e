// SPDX-License-Identifier: MIT
#include "lantern/raster/eye_line.h"

#include <algorithm>

namespace lantern {

using glm::dvec3;

/// Which side of the line the edge passes on; the same, turned round, for the triangle on its other
/// side.
int EyeLine::side_of(std::uint32_t from, std::uint32_t to) const {
  const dvec3 e(eye_);
  const dvec3 a = dvec3(vertices_[std::min(from, to)]) - e;
  const dvec3 b = dvec3(vertices_[std::max(from, to)]) - e;
  const dvec3 towards_light = dvec3(light_) - static_cast<double>(light_.w) * e;
  const int side = glm::dot(glm::cross(a, b), towards_light) >= 0.0 ? 1 : -1;
  return from < to ? side : -side;
}

bool EyeLine::meets(const Vec3& centre, float radius) const {
  constexpr float kSlack = 1.001f;  // rounding of this test, not of the others
  const Vec3 towards_light = Vec3(light_) - light_.w * eye_;
  const Vec3 off_line = glm::cross(centre - eye_, towards_light);
  return glm::dot(off_line, off_line) <=
         kSlack * radius * radius * glm::dot(towards_light, towards_light);
}

int EyeLine::crossing(const uvec3& triangle) const {
  const int side = side_of(triangle.x, triangle.y);
  if (side_of(triangle.y, triangle.z) != side) return 0;
  return side_of(triangle.z, triangle.x) == side ? side : 0;
}

bool EyeLine::is_parted_by(const uvec3& triangle) const {
  const dvec3 a(vertices_[triangle.x]);
  const dvec3 normal =
      glm::cross(dvec3(vertices_[triangle.y]) - a, dvec3(vertices_[triangle.z]) - a);
  const double eye = glm::dot(normal, dvec3(eye_) - a);
  const double light = glm::dot(normal, dvec3(light_) - static_cast<double>(light_.w) * a);
  return (eye >= 0.0) != (light >= 0.0);
}

}  // namespace lantern
