// SPDX-License-Identifier: MIT
// What the rasteriser is told of a render's options.
#pragma once

#include "lantern/pipeline/render.h"
#include "lantern/raster/rasteriser.h"

#include <cstddef>

namespace lantern {

inline RasterOptions raster_options(const RenderOptions& options) {
  // Of dealt lights each sample has its own; passes have new ones unless they are given. Passes
  // without end are many.
  std::size_t samples_of_lights = 1;
  if (!options.deal_lights || options.samples == 1) {
    samples_of_lights = static_cast<std::size_t>(options.samples);
    constexpr std::size_t kMany = 100;
    if (options.given_lights) samples_of_lights *= options.passes == 0 ? kMany : options.passes;
  }
  return {.width = options.width,
          .height = options.height,
          .samples = options.samples,
          .tile = options.tile,
          .shadows = options.shadows,
          .samples_of_lights = samples_of_lights,
          .deal_lights = options.deal_lights,
          .volumes = options.volumes,
          .show_volumes = options.show_volumes};
}

}  // namespace lantern
