// SPDX-License-Identifier: MIT
#include "lantern/radiosity/polygon_factor.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

/// Newell's normal, unit; its length is twice the area.
glm::dvec3 unit_normal(const Polygon& polygon) {
  const auto corners = polygon.corners();
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  const double length = glm::length(sum);
  return length > 0.0 ? sum / length : glm::dvec3(0.0);
}

/// An edge from `start` along `direction` (unit) of some length.
struct Edge {
  glm::dvec3 start, direction;
  double length;
};

/// The integral of ln |x - y| over the points y of an edge.
double log_distance_integral(const glm::dvec3& x, const Edge& edge) {
  const glm::dvec3 to = x - edge.start;
  const double along = glm::dot(to, edge.direction);
  const double across = glm::length(glm::cross(to, edge.direction));
  const auto antiderivative = [&](double z) {
    const double square = z * z + across * across;
    if (square == 0.0) return 0.0;
    return 0.5 * z * std::log(square) - z + across * std::atan2(z, across);
  };
  return antiderivative(edge.length - along) - antiderivative(-along);
}

/// Gauss-Legendre with eight points, exact for polynomials of degree 15. [Abramowitz & Stegun 1964,
/// table 25.4]
template <typename Function>
double gauss(double from, double to, const Function& f) {
  constexpr double kPlace[] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674,
                               0.96028985649753623};
  constexpr double kWeight[] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                0.10122853629037626};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    sum += kWeight[i] * (f(middle - half * kPlace[i]) + f(middle + half * kPlace[i]));
  }
  return half * sum;
}

/// Halves the interval until the halves agree with the whole. What is singular is so at points,
/// like s ln s: it loses three quarters of its error with each halving.
template <typename Function>
double adaptive(double from, double to, double whole, double tolerance, int depth,
                const Function& f) {
  const double middle = 0.5 * (from + to);
  const double left = gauss(from, middle, f), right = gauss(middle, to, f);
  constexpr int kDeepest = 24;
  if (std::abs(left + right - whole) <= tolerance || depth == kDeepest) return left + right;
  return adaptive(from, middle, left, tolerance, depth + 1, f) +
         adaptive(middle, to, right, tolerance, depth + 1, f);
}

/// The double integral of ln r along two edges.
double edge_integral(const Edge& a, const Edge& b, double tolerance) {
  const auto inner = [&](double s) { return log_distance_integral(a.start + s * a.direction, b); };
  return adaptive(0.0, a.length, gauss(0.0, a.length, inner), tolerance, 0, inner);
}

/// Edges in units of `unit`, about `origin`.
std::array<Edge, Polygon::kMost> edges_of(const Polygon& polygon, const glm::dvec3& origin,
                                          double unit) {
  std::array<Edge, Polygon::kMost> edges{};
  const auto corners = polygon.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 start = (corners[i] - origin) / unit;
    const glm::dvec3 along = (corners[(i + 1) % corners.size()] - corners[i]) / unit;
    const double length = glm::length(along);
    edges[i] = {start, length > 0.0 ? along / length : glm::dvec3(0.0), length};
  }
  return edges;
}

}  // namespace

Polygon::Polygon(std::span<const glm::dvec3> corners) {
  for (const glm::dvec3& corner : corners) add(corner);
}

void Polygon::add(const glm::dvec3& corner) {
  assert(size_ < kMost);
  corners_[size_++] = corner;
}

Polygon clip(const Polygon& polygon, const glm::dvec3& point, const glm::dvec3& normal) {
  Polygon result;
  const auto corners = polygon.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = corners[i], b = corners[(i + 1) % corners.size()];
    const double above_a = glm::dot(a - point, normal), above_b = glm::dot(b - point, normal);
    if (above_a >= 0.0) result.add(a);
    if (above_a * above_b < 0.0) result.add(a + (b - a) * (above_a / (above_a - above_b)));
  }
  return result;
}

double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon) {
  if (polygon.empty() || glm::dot(point - polygon.corners()[0], unit_normal(polygon)) <= 0.0) {
    return 0.0;
  }
  const Polygon seen = clip(polygon, point, normal);
  const auto corners = seen.corners();
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, normal);
  }
  // The front of the polygon looks at the point, so its corners run clockwise seen from there.
  return std::max(0.0, -sum / (2.0 * glm::pi<double>()));
}

double exchange_area(const Polygon& a, const Polygon& b) {
  if (a.empty() || b.empty()) return 0.0;
  const Polygon p = clip(a, b.corners()[0], unit_normal(b));
  const Polygon q = clip(b, a.corners()[0], unit_normal(a));
  if (p.empty() || q.empty()) return 0.0;
  // A factor common to all distances drops out of the closed contours: distances about 1 keep what
  // cancels small.
  const glm::dvec3 origin = p.corners()[0];
  double unit = 0.0;
  for (const glm::dvec3& corner : q.corners()) {
    unit = std::max(unit, glm::distance(corner, origin));
  }
  if (unit == 0.0) return 0.0;
  // The inner integral is a difference of values about 1, whose rounding no halving takes away.
  constexpr double kRelative = 1e-10, kRounding = 1e-14;
  const auto of_p = edges_of(p, origin, unit), of_q = edges_of(q, origin, unit);
  double sum = 0.0;
  for (std::size_t i = 0; i < p.corners().size(); ++i) {
    for (std::size_t j = 0; j < q.corners().size(); ++j) {
      const double cosine = glm::dot(of_p[i].direction, of_q[j].direction);
      const double lengths = of_p[i].length * of_q[j].length;
      if (cosine == 0.0 || lengths == 0.0) continue;
      const double tolerance = std::max(kRelative * lengths, kRounding * of_p[i].length);
      sum += cosine * edge_integral(of_p[i], of_q[j], tolerance);
    }
  }
  return std::max(0.0, sum * unit * unit / (2.0 * glm::pi<double>()));
}

}  // namespace lantern
