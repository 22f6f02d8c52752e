// SPDX-License-Identifier: MIT
// What the sides of shadow volumes are extruded from, and away from what.
#pragma once

#include "lantern/core/math.h"

#include <cstdint>

namespace lantern {

/// A light as the volumes see it: w = 1 and its position, or w = 0 and the direction towards it.
using LightPoint = Vec4;

/// Of two welded vertices. Seen from the outside of the volume the quad is to, from, from extruded,
/// to extruded, counter-clockwise.
struct VolumeEdge {
  std::uint32_t from, to;
  bool operator==(const VolumeEdge&) const = default;
};

}  // namespace lantern
