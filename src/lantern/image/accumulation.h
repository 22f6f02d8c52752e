// SPDX-License-Identifier: MIT
// The mean of any number of images.
#pragma once

#include "lantern/image/image.h"

#include <cstddef>
#include <vector>

namespace lantern {

/// Passes added up in double precision: thousands of them lose nothing.
class Accumulation {
 public:
  Accumulation(int width, int height)
      : width_(width),
        height_(height),
        sum_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  void add(const Image& pass) {
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += glm::dvec3(pass.pixels[i]);
    ++passes_;
  }
  Image mean() const {
    Image image(width_, height_);
    const double scale = passes_ > 0 ? 1.0 / static_cast<double>(passes_) : 0.0;
    for (std::size_t i = 0; i < sum_.size(); ++i) image.pixels[i] = Rgb(sum_[i] * scale);
    return image;
  }

 private:
  int width_, height_;
  std::vector<glm::dvec3> sum_;
  std::size_t passes_ = 0;
};

}  // namespace lantern
