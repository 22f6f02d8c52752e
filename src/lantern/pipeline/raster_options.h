// SPDX-License-Identifier: MIT
// What the rasteriser is told of a render's options.
#pragma once

#include "lantern/pipeline/render.h"
#include "lantern/raster/rasteriser.h"

namespace lantern {

inline RasterOptions raster_options(const RenderOptions& options) {
  return {.width = options.width,
          .height = options.height,
          .samples = options.samples,
          .tile = options.tile,
          .shadows = options.shadows,
          .deal_lights = options.deal_lights,
          .volumes = options.volumes,
          .show_volumes = options.show_volumes};
}

}  // namespace lantern
