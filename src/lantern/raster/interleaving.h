// SPDX-License-Identifier: MIT
// Each pixel of a tile takes its share of the lights, and neighbours on the same surface lend each
// other what they see. [Keller & Heidrich 2001, Interleaved Sampling; Segovia et al. 2006,
// Non-interleaved Deferred Shading of Interleaved Sample Patterns]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/light_masks.h"
#include "lantern/raster/light_round.h"
#include "lantern/raster/pixel_irradiance.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/tile_irradiance.h"
#include "lantern/raster/view.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace lantern {

class Interleaving {
 public:
  /// `options.step` x `options.step` pixels take all lights together; a power of 2. Keeps
  /// references to `surfaces`, `times` and what `shadows` points to.
  Interleaving(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
               const gl::ShaderFiles& files, const ViewOptions& options);

  /// The surfaces and what the lights of group_shares() give to them. `offset` is where in its
  /// pixel each sample lies. Calls `group_done` for each group that was; once it returns false the
  /// rest of the rounds are left out.
  void draw(const Camera& camera, const Vec2& offset, std::span<const LightGroup> groups,
            const std::function<bool()>& group_done);

  const GBuffer& g_buffer() const { return whole_; }
  /// Of all pixels, in W/m².
  const ColourQuads& irradiance() const { return irradiance_.irradiance(); }

 private:
  /// The pictures of all shares side by side: their depth or, if asked for, all of the G-buffer.
  struct SharePictures {
    std::optional<GBuffer> all;
    std::optional<gl::Texture> depth_alone;
    std::optional<gl::Framebuffer> depth_framebuffer;
    SharePictures(const glm::ivec2& size, bool asks_all);
    const gl::Texture& depth() const { return all ? all->depth : *depth_alone; }
    const gl::Framebuffer& framebuffer() const {
      return all ? all->framebuffer : *depth_framebuffer;
    }
  };

  void draw_surfaces(const View& view, std::span<const View> of_shares);
  void split(const View& view) const;
  /// Which of these lights, one group of each share, each share's pixels see.
  void look(LightRound& round, std::span<const View> of_shares, std::span<const LightGroup> groups);

  const Surfaces& surfaces_;
  StageTimes& times_;
  ViewOptions view_options_;
  int tile_;
  glm::ivec2 share_size_;  // how far apart pictures begin
  GBuffer whole_;
  SharePictures shares_;
  LightMasks masks_;
  gl::Program split_;
  std::vector<LightRound> rounds_;
  TileIrradiance tile_irradiance_;
  PixelIrradiance irradiance_;
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
