// SPDX-License-Identifier: MIT
// Many lights to few that stand for them: chosen in proportion to what they matter and well spread
// over the surfaces, so that a costly gather spends no rays on lights that hardly shine.
#pragma once

#include "lantern/lights/virtual_lights.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// What a light matters wherever it is looked at from: its share of the pool's flux, in the channel
/// where that is largest (from infinity: of its irradiance on `directional_area` m²).
std::vector<double> flux_weights(const VirtualLights& pool, double directional_area = 1.0);

/// At most `count` lights out of `pool`, whose expected flux is that of all lights of the pool that
/// have a positive weight, wherever it is gathered. One choice in each of `count` equal strata of
/// weight along a Hilbert curve through the lights' positions. Over passes the choice in each
/// stratum is equidistributed.
VirtualLights resample(const VirtualLights& pool, std::span<const double> weights,
                       std::size_t count, std::uint64_t pass);

}  // namespace lantern
