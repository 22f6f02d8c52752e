// SPDX-License-Identifier: MIT
// The copies of the gather's inner loop, one for each instruction set. All give the same bits.
#pragma once

#include "lantern/gather/kernel.h"

#include <cstddef>
#include <cstdint>

namespace lantern {

/// The arrays of a GatherLights.
struct LightSpans {
  const GatherLights::Surface* surface;
  const GatherLights::Point* point;
  const GatherLights::Directional* directional;
  std::size_t surface_count, point_count, directional_count;
};

using GatherKernel = std::uint64_t(const LightSpans& lights, const ShadingPacket& points,
                                   const Tracer& tracer, float bound, ShadowRays rays,
                                   IrradiancePacket& irradiance);

GatherKernel gather_irradiance_baseline;
#ifdef __x86_64__
GatherKernel gather_irradiance_avx2;
GatherKernel gather_irradiance_avx512;
#endif

}  // namespace lantern
