// SPDX-License-Identifier: MIT
#include "lantern/radiosity/exchange.h"

#include "lantern/radiosity/polygon_factor.h"

#include <algorithm>
#include <utility>

namespace lantern {
namespace {

/// The heights of the lowest and the highest corner of `shape` above the plane of `of`.
std::pair<double, double> heights(const ElementShape& shape, const ElementShape& of) {
  double low = glm::dot(shape.corners[0] - of.centre, of.normal), high = low;
  for (int k = 1; k < 3; ++k) {
    const double height =
        glm::dot(shape.corners[static_cast<std::size_t>(k)] - of.centre, of.normal);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return {low, high};
}

/// A point of a rule on a triangle: weights of the corners and of the value.
struct Node {
  double a, b, c, weight;
};

/// Exact to degree 2 and 4. [Strang & Fix 1973, An Analysis of the Finite Element Method,
/// table 4.1]
constexpr double kThird = 1.0 / 3.0, kSixth = 1.0 / 6.0, kTwoThirds = 2.0 / 3.0;
constexpr std::array<Node, 3> kThree = {{{kTwoThirds, kSixth, kSixth, kThird},
                                         {kSixth, kTwoThirds, kSixth, kThird},
                                         {kSixth, kSixth, kTwoThirds, kThird}}};
constexpr double kP = 0.816847572980459, kQ = 0.091576213509771, kPWeight = 0.109951743655322;
constexpr double kR = 0.108103018168070, kS = 0.445948490915965, kRWeight = 0.223381589678011;
constexpr std::array<Node, 6> kSix = {{{kP, kQ, kQ, kPWeight},
                                       {kQ, kP, kQ, kPWeight},
                                       {kQ, kQ, kP, kPWeight},
                                       {kR, kS, kS, kRWeight},
                                       {kS, kR, kS, kRWeight},
                                       {kS, kS, kR, kRWeight}}};

template <std::size_t kNodes>
double cubature(const ElementShape& a, const ElementShape& b,
                const std::array<Node, kNodes>& rule) {
  const auto at = [](const ElementShape& shape, const Node& node) {
    return node.a * shape.corners[0] + node.b * shape.corners[1] + node.c * shape.corners[2];
  };
  std::array<glm::dvec3, kNodes> on_b;
  for (std::size_t j = 0; j < kNodes; ++j) on_b[j] = at(b, rule[j]);
  double sum = 0.0;
  for (const Node& node : rule) {
    const glm::dvec3 x = at(a, node);
    for (std::size_t j = 0; j < kNodes; ++j) {
      const glm::dvec3 way = on_b[j] - x;
      const double square = glm::dot(way, way);
      sum += node.weight * rule[j].weight * glm::dot(way, a.normal) * -glm::dot(way, b.normal) /
             (square * square);
    }
  }
  return sum * a.area * b.area / glm::pi<double>();
}

}  // namespace

ElementShape shape_of(const Patches& patches, std::size_t element) {
  const std::uint32_t patch = patches.patch[element];
  ElementShape shape;
  for (int k = 0; k < 3; ++k) {
    const int from = patches.is_front(element) ? k : 2 - k;
    shape.corners[static_cast<std::size_t>(k)] = patches.mesh.corner(patch, from);
  }
  shape.normal = patches.element_normal(element);
  shape.centre = patches.centre[patch];
  shape.area = patches.area[patch];
  for (const glm::dvec3& corner : shape.corners) {
    shape.radius = std::max(shape.radius, glm::distance(corner, shape.centre));
  }
  return shape;
}

double unoccluded_exchange(const ElementShape& a, const ElementShape& b, double flat) {
  const auto [a_low, a_high] = heights(a, b);
  const auto [b_low, b_high] = heights(b, a);
  if (a_high <= flat || b_high <= flat) return 0.0;
  // Where the cubatures take over, in radii per distance: measured on random pairs of triangles.
  constexpr double kFar = 0.15, kMiddle = 0.45;
  const double nearness = (a.radius + b.radius) / glm::distance(a.centre, b.centre);
  if (nearness < kMiddle && a_low >= 0.0 && b_low >= 0.0) {
    return nearness < kFar ? cubature(a, b, kThree) : cubature(a, b, kSix);
  }
  return exchange_area(Polygon(a.corners), Polygon(b.corners));
}

}  // namespace lantern
