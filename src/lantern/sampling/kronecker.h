// SPDX-License-Identifier: MIT
// Kronecker sequences: multiples of a pair of irrationals, modulo 1.
#pragma once

#include "lantern/core/hash.h"
#include "lantern/core/math.h"

#include <cstdint>

namespace lantern {

/// The n-th member of the Kronecker sequence of a pair of irrationals, shifted.
inline Vec2 kronecker(std::uint64_t n, glm::dvec2 irrational, Vec2 shift) {
  const glm::dvec2 u = glm::fract(static_cast<double>(n) * irrational + glm::dvec2(shift));
  return glm::min(Vec2(u), Vec2(kBelowOne));
}

/// Where in its pixel sample n lies, in [0, 1)²; sample 0 in the middle. By powers of the plastic
/// number: the first n points are well spread for every n. [Roberts 2018, The Unreasonable
/// Effectiveness of Quasirandom Sequences]
inline Vec2 place_in_pixel(std::uint64_t n) {
  constexpr double kPlastic = 1.32471795724474602596;
  constexpr glm::dvec2 kSequence(1.0 / kPlastic, 1.0 / (kPlastic * kPlastic));
  return kronecker(n, kSequence, Vec2(0.5f));
}

}  // namespace lantern
