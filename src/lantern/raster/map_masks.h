// SPDX-License-Identifier: MIT
// Which of up to 32 lights each pixel sees, as the bits of a mask, by shadow maps: what they tell
// of tiles of pixels at once and, where that does not suffice, of each pixel's point.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <array>
#include <optional>

namespace lantern {

class MapMasks {
 public:
  /// Of views of this size. Keeps a reference to `maps`.
  MapMasks(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height);

  /// The points that the next masks are for.
  void look_at(const GBuffer& g_buffer);
  /// Bit i of the result (RGBA8, the lowest byte in red): whether light i of the group is seen and
  /// has its bit in `asked`; in the view's part. Draws the group's maps where they are not there.
  const gl::Texture& draw(const LightGroup& group, const View& view, const GBuffer& g_buffer,
                          const gl::Texture& asked, StageTimes& times);

 private:
  struct Programs {
    gl::Program of_groups, of_tiles, of_quads;
    Programs(const gl::ShaderFiles& files, LightFormula formula);
  };

  /// What is known of some tiles: what encloses them, and what maps told of them last.
  struct Tiles {
    gl::Texture spheres, normals, told;
    gl::Framebuffer framebuffer, told_framebuffer;
    Tiles(int width, int height);
  };

  Bounds bounds_of_tiles() const;
  void ask(const gl::Program& program, const Tiles& tiles, const View& view);

  ShadowMaps& maps_;
  gl::Program of_pixels_, of_tiles_, of_groups_, take_apart_;
  std::array<Programs, kLightFormulas> programs_;
  Tiles groups_, tiles_;
  gl::Texture receivers_, masks_of_quads_, mask_;
  gl::Framebuffer receiver_framebuffer_, quad_framebuffer_, mask_framebuffer_;
  std::optional<Bounds> box_;  // around the points, once it is asked for
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
