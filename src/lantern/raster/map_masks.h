// SPDX-License-Identifier: MIT
// Which of up to 32 lights each pixel sees, as the bits of a mask, by shadow maps.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/map_tiles.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <vector>

namespace lantern {

class MapMasks {
 public:
  /// Of views of this size. Keeps a reference to `maps`.
  MapMasks(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height);

  /// The points that the next masks are for.
  void look_at(const GBuffer& g_buffer) { tiles_.look_at(g_buffer); }
  /// Bit i of the result (RGBA8, the lowest byte in red): whether light i of the group is seen and
  /// has its bit in `asked`; in the view's part.
  const gl::Texture& draw(const LightGroup& group, const View& view, const GBuffer& g_buffer,
                          const gl::Texture& asked, StageTimes& times);

 private:
  MapTiles tiles_;
  std::vector<gl::Program> ask_quads_;  // by formula
  gl::Program take_apart_;
  gl::Texture masks_of_quads_, mask_;
  gl::Framebuffer quad_framebuffer_, mask_framebuffer_;
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
