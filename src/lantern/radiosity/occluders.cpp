// SPDX-License-Identifier: MIT
#include "lantern/radiosity/occluders.h"

#include <algorithm>
#include <numeric>

namespace lantern {
namespace {

bool apart(const glm::dvec3& low_a, const glm::dvec3& high_a, const glm::dvec3& low_b,
           const glm::dvec3& high_b) {
  return glm::any(glm::greaterThan(low_a, high_b)) || glm::any(glm::greaterThan(low_b, high_a));
}

}  // namespace

ShapeBounds bounds_of(std::span<const ElementShape> shapes) {
  ShapeBounds bounds{shapes[0].corners[0], shapes[0].corners[0]};
  for (const ElementShape& shape : shapes) {
    for (const glm::dvec3& corner : shape.corners) {
      bounds.low = glm::min(bounds.low, corner);
      bounds.high = glm::max(bounds.high, corner);
    }
  }
  return bounds;
}

Occluders::Occluders(const World& world, double flat)
    : flat_(flat), triangles_(world.size()), all_(world.size()) {
  std::iota(all_.begin(), all_.end(), 0u);
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    Triangle& triangle = triangles_[t];
    for (int k = 0; k < 3; ++k) {
      triangle.corners[k] = glm::dvec3(world.positions[world.triangles[t][k]]);
    }
    triangle.normal = glm::normalize(glm::cross(triangle.corners[1] - triangle.corners[0],
                                                triangle.corners[2] - triangle.corners[0]));
    triangle.low =
        glm::min(triangle.corners[0], glm::min(triangle.corners[1], triangle.corners[2]));
    triangle.high =
        glm::max(triangle.corners[0], glm::max(triangle.corners[1], triangle.corners[2]));
  }
}

std::vector<std::uint32_t> Occluders::between(const ShapeBounds& a, const ShapeBounds& b,
                                              std::span<const std::uint32_t> candidates) const {
  const glm::dvec3 low = glm::min(a.low, b.low), high = glm::max(a.high, b.high);
  std::vector<std::uint32_t> result;
  for (const std::uint32_t t : candidates) {
    const Triangle& triangle = triangles_[t];
    if (apart(triangle.low, triangle.high, low, high)) continue;
    // Both boxes on one side of its plane: nothing between them crosses it.
    double least = 0.0, most = 0.0;
    for (const ShapeBounds* box : {&a, &b}) {
      const double middle =
          glm::dot(0.5 * (box->low + box->high) - triangle.corners[0], triangle.normal);
      const double reach = 0.5 * glm::dot(box->high - box->low, glm::abs(triangle.normal));
      least = std::min(least, middle - reach);
      most = std::max(most, middle + reach);
    }
    if (least < -flat_ && most > flat_) result.push_back(t);
  }
  return result;
}

bool Occluders::any_between(const ElementShape& a, const ElementShape& b,
                            std::span<const std::uint32_t> candidates) const {
  glm::dvec3 low = a.corners[0], high = low;
  for (const ElementShape* shape : {&a, &b}) {
    for (const glm::dvec3& corner : shape->corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  const auto blocks = [&](const Triangle& triangle) {
    if (apart(triangle.low, triangle.high, low, high)) return false;
    double least = 0.0, most = 0.0;
    for (const ElementShape* shape : {&a, &b}) {
      for (const glm::dvec3& corner : shape->corners) {
        const double height = glm::dot(corner - triangle.corners[0], triangle.normal);
        least = std::min(least, height);
        most = std::max(most, height);
      }
    }
    if (least >= -flat_ || most <= flat_) return false;
    // What lies behind one of the two cannot hide it.
    for (const ElementShape* shape : {&a, &b}) {
      double highest = -1.0;
      for (const glm::dvec3& corner : triangle.corners) {
        highest = std::max(highest, glm::dot(corner - shape->centre, shape->normal));
      }
      if (highest <= flat_) return false;
    }
    return true;
  };
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](std::uint32_t t) { return blocks(triangles_[t]); });
}

}  // namespace lantern
