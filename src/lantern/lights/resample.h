// SPDX-License-Identifier: MIT
// Many lights to few that stand for them: chosen in proportion to flux and well spread over the
// surfaces, so that a costly gather spends no rays on lights that hardly shine.
#pragma once

#include "lantern/lights/virtual_lights.h"

#include <cstddef>

namespace lantern {

/// At most `count` lights out of `pool`, whose expected flux is that of the pool wherever it is
/// gathered. One choice in each of `count` equal strata of weight along a Hilbert curve through the
/// lights' positions; the weight of a light is its flux in the channel where it counts most,
/// relative to the pool's (from infinity: its irradiance on `directional_area` m²). Over passes the
/// choice in each stratum is equidistributed.
VirtualLights resample(const VirtualLights& pool, std::size_t count, std::uint64_t pass,
                       double directional_area = 1.0);

}  // namespace lantern
