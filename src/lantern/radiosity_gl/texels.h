// SPDX-License-Identifier: MIT
// Arrays as RGBA32F textures: value i lies at (i % width, i / width).
#pragma once

#include "lantern/core/math.h"
#include "lantern/gl/objects.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace lantern {

/// Twice as wide as high or so, since some textures stack several layers.
struct TexelGrid {
  int width, height;

  explicit TexelGrid(std::size_t count) {
    constexpr unsigned kNarrowest = 16;
    const auto side = static_cast<unsigned>(std::ceil(std::sqrt(2.0 * static_cast<double>(count))));
    width = static_cast<int>(std::max(std::bit_ceil(side), kNarrowest));
    height = std::max(1, static_cast<int>((count + static_cast<std::size_t>(width) - 1) /
                                          static_cast<std::size_t>(width)));
  }
  std::size_t texels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

inline std::span<const float> channels_of(const std::vector<Vec4>& values) {
  static_assert(sizeof(Vec4) == 4 * sizeof(float));
  return {&values.data()->x, 4 * values.size()};
}

/// `layers` grids, one above the other, of grid.texels() values each.
inline gl::Texture make_texture(const TexelGrid& grid, const std::vector<Vec4>& values,
                                int layers = 1) {
  gl::Texture texture(gl::Format::kRgba32f, grid.width, layers * grid.height);
  texture.write<float>(channels_of(values));
  return texture;
}

}  // namespace lantern
