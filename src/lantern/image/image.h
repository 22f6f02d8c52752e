// SPDX-License-Identifier: MIT
// A picture: linear Rec. 709 radiance in W/(m² sr), row 0 at the top, pixels row by row.
#pragma once

#include "lantern/core/math.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace lantern {

struct Image {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h, Rgb fill = Rgb(0.0f))
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  Rgb& at(int x, int y) { return pixels[offset(x, y)]; }
  const Rgb& at(int x, int y) const { return pixels[offset(x, y)]; }

 private:
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// What an image file says about itself: options, version. Keys are plain ASCII words.
using Metadata = std::map<std::string, std::string>;

}  // namespace lantern
