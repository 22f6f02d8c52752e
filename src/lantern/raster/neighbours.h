// SPDX-License-Identifier: MIT
// Which triangles of a World share edges, by the places of their corners, whatever the vertices.
#pragma once

#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace lantern {

inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// Of each triangle and edge (from its corner of this number to the next) a triangle without holes
/// that shares it, or kNoTriangle. Those of one edge follow each other in a ring; triangles with
/// holes have no neighbours.
std::vector<std::array<std::uint32_t, 3>> find_neighbours(const Scene& scene, const World& world);

}  // namespace lantern
