// SPDX-License-Identifier: MIT
// The triangles of a World in patches of neighbours that lie behind each other's planes, as those
// of a ball or of a flat wall do: no triangle of a patch is between a point of it, seen from
// outside, and a light that the point faces.
#pragma once

#include "lantern/raster/neighbours.h"
#include "lantern/scene/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// Which sides of a patch are outside of it, as bits; a flat patch has both.
enum PatchSides : std::uint32_t { kFrontIsOutside = 1, kBackIsOutside = 2 };

struct ConvexPatches {
  struct Patch {
    std::uint32_t first, count;  // of the order
  };
  std::vector<std::uint32_t> order;  // of the triangles, patch by patch
  std::vector<Patch> patches;
  std::vector<std::uint32_t> patch_of;  // of each triangle
  std::vector<std::uint32_t> sides;     // PatchSides of each triangle
};

ConvexPatches find_convex_patches(const World& world,
                                  std::span<const std::array<std::uint32_t, 3>> neighbours);

}  // namespace lantern
