// SPDX-License-Identifier: MIT
// Choice in proportion to given weights, in one and two dimensions, by the inverse of the cumulated
// sums. The random number is stretched, so that what is left of it can be used again.
#pragma once

#include "lantern/core/math.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lantern {

/// Discrete distribution over the indices of `weights` (not negative, finite; sum above zero).
class Distribution {
 public:
  Distribution() = default;
  explicit Distribution(std::span<const double> weights);

  struct Choice {
    std::size_t index = 0;
    float probability = 0.0f;
    // The given number, stretched to [0, 1) within the chosen index. Of the 24 bits of a float it
    // keeps those that the choice did not use: log2(1 / probability) fewer.
    float rest = 0.0f;
  };
  Choice choose(float u) const;  // u in [0, 1)

  float probability(std::size_t index) const;
  double sum() const { return sum_; }
  std::size_t size() const { return cumulated_.empty() ? 0 : cumulated_.size() - 1; }

 private:
  std::vector<double> cumulated_;  // starts with 0, ends with 1
  double sum_ = 0.0;
};

/// Piecewise constant density over the unit square: rows of cells, row 0 at y = 0.
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const double> weights, int width, int height);

  struct Point {
    Vec2 position;     // in the unit square
    float pdf = 0.0f;  // with respect to area of the unit square
  };
  Point sample(Vec2 u) const;
  float pdf(Vec2 position) const;

 private:
  int width_ = 0;
  int height_ = 0;
  Distribution rows_;
  std::vector<Distribution> columns_;
};

}  // namespace lantern
