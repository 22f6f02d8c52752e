// SPDX-License-Identifier: MIT
// Which triangles of a World can stand between two elements: a conservative test, so that pairs
// with none need no rays. Groups of elements are tested first. [after Haines & Wallace 1991, Shaft
// Culling for Efficient Ray-Traced Radiosity]
#pragma once

#include "lantern/radiosity/exchange.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// A box about elements.
struct ShapeBounds {
  glm::dvec3 low, high;
};
ShapeBounds bounds_of(std::span<const ElementShape> shapes);

class Occluders {
 public:
  /// `flat` as in unoccluded_exchange().
  Occluders(const World& world, double flat);

  /// All triangles.
  const std::vector<std::uint32_t>& all() const { return all_; }
  /// Those of `candidates` that may stand between something in `a` and something in `b`.
  std::vector<std::uint32_t> between(const ShapeBounds& a, const ShapeBounds& b,
                                     std::span<const std::uint32_t> candidates) const;
  /// Whether any of `candidates` may stand between the two.
  bool any_between(const ElementShape& a, const ElementShape& b,
                   std::span<const std::uint32_t> candidates) const;

 private:
  struct Triangle {
    glm::dvec3 corners[3];
    glm::dvec3 normal, low, high;
  };

  double flat_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> all_;
};

}  // namespace lantern
