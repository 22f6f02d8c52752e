// SPDX-License-Identifier: MIT
// Patches -> places in a square picture for the light on them: a chart for each flat, connected
// part of one material, on each side that light can come to. The scale is the same everywhere.
// Texels count from the upper left corner, x right, y down. Errors: Error where the borders alone
// leave no room.
#pragma once

#include "lantern/radiosity/patches.h"
#include "lantern/scene/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

/// Texels around each chart that its light is carried into: bilinear filters take from one.
inline constexpr int kChartBorder = 2;

struct Chart {
  int x = 0, y = 0, width = 0, height = 0;  // with its border
  std::vector<std::uint32_t> elements;
};

struct Atlas {
  int size = 0;  // texels along a side
  double texels_per_metre = 0.0;
  std::vector<Chart> charts;
  std::vector<std::uint32_t> chart;          // of each element
  std::vector<std::array<Vec2, 3>> corners;  // of each element's patch, in its order, in texels
};

/// `world` is the one that the patches were made of.
Atlas make_atlas(const World& world, const Patches& patches, int size);

}  // namespace lantern
