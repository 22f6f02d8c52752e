// SPDX-License-Identifier: MIT
#include "lantern/path/variance.h"

#include <cassert>

namespace lantern {

VarianceEstimate::VarianceEstimate(int width, int height, int samples)
    : width_(width), height_(height), samples_(samples) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  sum_.resize(pixels);
  pass_squares_.resize(pixels);
  sample_squares_.resize(pixels);
}

void VarianceEstimate::add(const PathPass& pass) {
  assert(pass.squared_radiance.pixels.size() == sum_.size());
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const glm::dvec3 mean(pass.radiance.pixels[i]);
    sum_[i] += mean;
    pass_squares_[i] += mean * mean;
    sample_squares_[i] += glm::dvec3(pass.squared_radiance.pixels[i]);
  }
  ++passes_;
}

Image VarianceEstimate::of_mean() const {
  Image image(width_, height_);
  if (passes_ == 0) return image;
  const bool from_passes = passes_ >= kFewPasses;
  const std::vector<glm::dvec3>& squares = from_passes ? pass_squares_ : sample_squares_;
  const auto passes = static_cast<double>(passes_);
  const double values = from_passes ? passes : passes * samples_;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const glm::dvec3 mean = sum_[i] / passes;
    const glm::dvec3 spread = squares[i] / passes - mean * mean;
    image.pixels[i] = Rgb(values > 1.0 ? glm::max(spread, 0.0) / (values - 1.0) : mean * mean);
  }
  return image;
}

}  // namespace lantern
