// SPDX-License-Identifier: MIT
// Which lights each sample, and each pixel of a tile, takes. [Keller 1997; Keller & Heidrich 2001,
// Interleaved Sampling]
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/raster_lights.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// Lights and, for each of them, the bound on its geometry term; none: no bounds.
struct BoundedLights {
  VirtualLights lights;
  std::vector<float> bounds;
};
BoundedLights chosen_of(const VirtualLights& lights, std::span<const float> bounds,
                        std::span<const std::uint32_t> chosen);

/// Lights in `shares` sets, each well spread: paths that follow one another are, so every bounce's
/// are cut into runs; which of them a set gets moves on with `turn`. Indices into the lights.
std::vector<std::vector<std::uint32_t>> share_out(const VirtualLights& lights, std::size_t shares,
                                                  std::size_t turn);

/// Those that one of `shares` samples is dealt, as strong as all of them together.
BoundedLights deal(const VirtualLights& lights, std::span<const float> bounds, std::size_t shares,
                   std::size_t sample, std::size_t turn);

/// The lights of `shares` pixels, round by round, as many in a group as lets those of a round go
/// into one uniform block of kLightsInRound.
std::vector<LightGroup> group_shares(const VirtualLights& lights, std::span<const float> bounds,
                                     float coordinate_scale, std::size_t shares, std::size_t turn);
/// As many as every GL has room for.
inline constexpr std::size_t kLightsInRound = 16384 / sizeof(LightRecord);

}  // namespace lantern
