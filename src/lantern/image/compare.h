// SPDX-License-Identifier: MIT
// How far one picture is from another.
#pragma once

#include "lantern/image/image.h"

namespace lantern {

struct Comparison {
  double rmse = 0.0;    // root of the mean squared difference over pixels and channels
  double relmse = 0.0;  // mean of (a-b)²/(b²+0.01) over pixels and channels, b the reference
  double max_difference = 0.0;
  glm::dvec3 mean_a{0.0};
  glm::dvec3 mean_b{0.0};
};

/// `b` is the reference. Throws Error if the sizes differ or a value is not finite.
Comparison compare(const Image& a, const Image& b);

}  // namespace lantern
