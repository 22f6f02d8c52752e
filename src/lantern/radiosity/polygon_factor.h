// SPDX-License-Identifier: MIT
// Form factors of planar convex polygons with nothing between them, in closed form. Corners run
// counter-clockwise seen from the front; only fronts send and receive, and what lies behind the
// other's plane is cut off first. Double precision; errors below 1e-8 of the factor's own bound.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace lantern {

/// A convex polygon of up to eight corners: a triangle that planes have cut keeps at most four or
/// five of them.
class Polygon {
 public:
  static constexpr std::size_t kMost = 8;

  Polygon() = default;
  explicit Polygon(std::span<const glm::dvec3> corners);

  std::span<const glm::dvec3> corners() const { return {corners_.data(), size_}; }
  bool empty() const { return size_ < 3; }
  void add(const glm::dvec3& corner);

 private:
  std::array<glm::dvec3, kMost> corners_;
  std::size_t size_ = 0;
};

/// The part with dot(x - point, normal) > 0. [Sutherland & Hodgman 1974]
Polygon clip(const Polygon& polygon, const glm::dvec3& point, const glm::dvec3& normal);

/// Form factor from a point of a surface with that unit normal to a polygon. [Lambert 1760,
/// Photometria; as a sum over edges: Baum, Rushmeier & Winget 1989, equation 5]
double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon);

/// A_i F_ij = A_j F_ji in m², the area integral of cos θ_i cos θ_j / (π r²) over both polygons, as
/// an integral over both contours, exact along one and adaptive along the other, so that polygons
/// may share corners and edges. [Sparrow 1963; Goral et al. 1984, equation 10]
double exchange_area(const Polygon& a, const Polygon& b);

}  // namespace lantern
