// SPDX-License-Identifier: MIT
// What the rasteriser is told of a render's options.
#pragma once

#include "lantern/pipeline/render.h"
#include "lantern/raster/rasteriser.h"

#include <algorithm>
#include <cstddef>

namespace lantern {

inline RasterOptions raster_options(const RenderOptions& options) {
  // Of dealt lights each sample has its own; passes have new ones unless they are given.
  std::size_t samples_of_lights =
      options.deal_lights ? 1 : static_cast<std::size_t>(options.samples);
  if (options.given_lights) samples_of_lights *= std::max<std::size_t>(options.passes, 1);
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
