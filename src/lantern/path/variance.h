// SPDX-License-Identifier: MIT
// The variance of the mean of passes, pixel by pixel and channel by channel. Passes are randomised
// independently of each other, the samples of one pass are not: they fill each other's gaps. So
// with kFewPasses or more it is the unbiased estimate from the passes' means; with fewer, whose
// spread says little, that of samples taken as if they were independent, which is rather too large.
#pragma once

#include "lantern/image/image.h"
#include "lantern/path/path_tracer.h"

#include <cstddef>
#include <vector>

namespace lantern {

class VarianceEstimate {
 public:
  /// The error of a standard deviation from eight passes is a quarter of it.
  static constexpr std::size_t kFewPasses = 8;

  VarianceEstimate(int width, int height, int samples);

  /// `pass` must have its squares.
  void add(const PathPass& pass);

  /// The variance of the mean of all passes added. Of one sample in all it cannot be known: then
  /// the square of its value, as if the next might as well be black.
  Image of_mean() const;

 private:
  int width_, height_, samples_;
  std::size_t passes_ = 0;
  std::vector<glm::dvec3> sum_;             // of passes' means
  std::vector<glm::dvec3> pass_squares_;    // of the squares of passes' means
  std::vector<glm::dvec3> sample_squares_;  // of passes' means of the squares
};

}  // namespace lantern
