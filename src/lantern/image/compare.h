// SPDX-License-Identifier: MIT
// How far one picture is from another. Sums are taken in double precision in the order of the
// pixels, so that the numbers do not depend on anything but the pictures. Errors: Error if the
// pictures have no pixels, differ in size or hold a value that is not finite (the first is named).
#pragma once

#include "lantern/image/image.h"

namespace lantern {

/// Keeps the relative error of black reference pixels bounded.
inline constexpr double kRelativeFloor = 0.01;

struct Comparison {
  double rmse = 0.0;    // root of the mean of (a-b)² over pixels and channels
  double relmse = 0.0;  // mean of (a-b)²/(b²+0.01) over pixels and channels, b the reference
  double max_difference = 0.0;  // largest |a-b| of any pixel and channel
  glm::dvec3 mean_a{0.0};       // per channel
  glm::dvec3 mean_b{0.0};
};

/// Throws the errors named above.
void require_comparable(const Image& a, const Image& b);

/// `b` is the reference.
Comparison compare(const Image& a, const Image& b);

}  // namespace lantern
