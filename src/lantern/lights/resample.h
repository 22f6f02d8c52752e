// SPDX-License-Identifier: MIT
// Many lights to few that stand for them: chosen in proportion to flux and well spread over the
// surfaces, so that a costly gather spends no rays on lights that hardly shine.
#pragma once

#include "lantern/lights/virtual_lights.h"

#include <cstddef>

namespace lantern {

/// At most `count` lights out of `pool`, whose expected flux is that of the pool wherever it is
/// gathered. Systematic sampling along a Hilbert curve through the lights' positions: the weight of
/// a light is its flux, each channel relative to the pool's; `u` in [0, 1) shifts the comb and
/// should be equidistributed over passes.
VirtualLights resample(const VirtualLights& pool, std::size_t count, double u);

}  // namespace lantern
