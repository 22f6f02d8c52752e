// SPDX-License-Identifier: MIT
#include "lantern/image/compare.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

void require_finite(const Image& image, std::size_t i, const char* which) {
  const Rgb& c = image.pixels[i];
  if (is_finite(c)) return;
  const auto width = static_cast<std::size_t>(image.width);
  throw Error(fmt::format("the {} picture is not finite at pixel ({}, {}): {} {} {}", which,
                          i % width, i / width, c.r, c.g, c.b));
}

}  // namespace

void require_comparable(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw Error(fmt::format("the pictures differ in size: {}x{} and {}x{}", a.width, a.height,
                            b.width, b.height));
  }
  if (a.pixels.empty()) throw Error("the pictures to compare have no pixels");
  assert(a.pixels.size() == b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    require_finite(a, i, "first");
    require_finite(b, i, "second");
  }
}

Comparison compare(const Image& a, const Image& b) {
  require_comparable(a, b);
  Comparison result;
  double squared = 0.0;
  double relative = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 value(a.pixels[i]);
    const glm::dvec3 reference(b.pixels[i]);
    result.mean_a += value;
    result.mean_b += reference;
    for (int c = 0; c < 3; ++c) {
      const double difference = value[c] - reference[c];
      squared += difference * difference;
      relative += difference * difference / (reference[c] * reference[c] + kRelativeFloor);
      result.max_difference = std::max(result.max_difference, std::abs(difference));
    }
  }
  const auto pixels = static_cast<double>(a.pixels.size());
  result.rmse = std::sqrt(squared / (3.0 * pixels));
  result.relmse = relative / (3.0 * pixels);
  result.mean_a /= pixels;
  result.mean_b /= pixels;
  return result;
}

}  // namespace lantern
