// SPDX-License-Identifier: MIT
// What a view sees and how much light gets there: surfaces into a G-buffer, which lights each pixel
// sees, 32 lights shaded at a time.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/light_masks.h"
#include "lantern/raster/map_tiles.h"
#include "lantern/raster/masked_shading.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <functional>
#include <optional>
#include <span>

namespace lantern {

class Lighting {
 public:
  /// Of views of this size. Keeps references to `surfaces`, `times` and what `shadows` points to.
  Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
           const gl::ShaderFiles& files, int width, int height);

  /// Calls `group_done` after each group; once it returns false the rest is left out.
  void draw(const View& view, std::span<const LightGroup> groups,
            const std::function<bool()>& group_done);

  const GBuffer& g_buffer() const { return g_buffer_; }
  /// What there is by now.
  const MaskedShading& shading() const { return shading_; }

 private:
  void add(const View& view, const LightGroup& group, bool is_first);

  const Surfaces& surfaces_;
  StageTimes& times_;
  GBuffer g_buffer_;
  // What all but the last maps tell is a mask; those are asked where light is added.
  struct Masks {
    LightMasks of_lights;
    MaskPicture picture;
  };
  std::optional<Masks> masks_;
  std::optional<MapTiles> last_maps_;
  MaskedShading shading_;
};

}  // namespace lantern
