// SPDX-License-Identifier: MIT
// More triangles for the same surfaces: to see what triangles cost, or to have points to move.
#pragma once

#include "lantern/scene/world.h"

namespace lantern {

/// Each triangle cut into pieces x pieces of its shape, `pieces` >= 1. Triangles that shared an
/// edge still do, point for point; what vertices carry is interpolated.
World subdivided(const World& world, std::uint32_t pieces);

}  // namespace lantern
