// SPDX-License-Identifier: MIT
// What each light of a pool matters to the picture: its share of the light at points that the
// camera sees, found by shadow rays. [Georgiev & Slusallek 2010, Simple and Robust Iterative
// Importance Sampling of Virtual Point Lights]
#pragma once

#include "lantern/gather/gather.h"

#include <cstddef>
#include <vector>

namespace lantern {

/// One weight for each light of the pool, none negative, in no unit: the sum over the points of the
/// light's part of what all lights give there, in the channel where that is largest. 0 for a light
/// that none of the points sees. Of `options` it takes the size, the pass and the seed.
std::vector<double> importance(const GatherInput& input, const VirtualLights& pool,
                               const GatherOptions& options);

}  // namespace lantern
