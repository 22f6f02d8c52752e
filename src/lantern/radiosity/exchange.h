// SPDX-License-Identifier: MIT
// A_i F_ij of two sides of patches with nothing between them, in m²: in closed form where they are
// close, by cubature over both where its error is below kCubatureError of the value.
#pragma once

#include "lantern/radiosity/patches.h"

#include <array>

namespace lantern {

inline constexpr double kCubatureError = 1e-3;

/// One side of a patch; the corners run counter-clockwise seen from there.
struct ElementShape {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 normal, centre;
  double area = 0.0;
  double radius = 0.0;  // around the centre
};

ElementShape shape_of(const Patches& patches, std::size_t element);

/// `flat` is how far from a plane, in metres, a corner still counts as on it.
double unoccluded_exchange(const ElementShape& a, const ElementShape& b, double flat);

}  // namespace lantern
