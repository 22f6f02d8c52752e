// SPDX-License-Identifier: MIT
// Each pixel of a tile takes its share of the lights, and neighbours on the same surface lend each
// other what they see. [Keller & Heidrich 2001, Interleaved Sampling; Segovia et al. 2006,
// Non-interleaved Deferred Shading of Interleaved Sample Patterns]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/light_masks.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <array>
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
  /// The irradiance of all pixels in W/m², for shaders/resolve.frag.glsl, on three texture units
  /// from `unit` on.
  void set_irradiance(const gl::Program& program, int unit) const;
  /// What its shaders, and those that read its irradiance, are defined with.
  static std::vector<gl::Definition> definitions(int tile);

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
  /// Red, green and blue of up to four pixels of a row a texel.
  struct Quads {
    gl::Texture red, green, blue;
    gl::Framebuffer framebuffer;
    Quads(int width, int height, const gl::Texture& stencil);
    void set_in(const gl::Program& program, int unit) const;
  };
  /// Likewise of four tiles, and how much of that changes around.
  struct TileQuads {
    gl::Texture red, green, blue, changes;
    gl::Framebuffer framebuffer;
    TileQuads(int width, int height);
    void set_in(const gl::Program& program, int unit) const;
  };
  /// A group of each share.
  struct Round {
    MaskPicture masks;
    gl::Texture lights_of;
    gl::Buffer lights;
    LightFormula formula = LightFormula::kSurface;
    Round(const gl::Texture& depth, int shares);
  };

  void draw_surfaces(const View& view, std::span<const View> of_shares);
  void split(const View& view) const;
  /// Which of these lights, one group of each share, each share's pixels see.
  void look(Round& round, std::span<const View> of_shares, std::span<const LightGroup> groups);
  /// What a program of a round reads.
  void set_in(const gl::Program& program, const Round& round, bool first) const;
  void add_to_tiles(const Round& round, bool first);
  void add_to_pixels(const Round& round, bool first, const View& view);
  void fill(const View& view, std::size_t rounds);

  const Surfaces& surfaces_;
  StageTimes& times_;
  ViewOptions view_options_;
  int tile_;
  glm::ivec2 tiles_, share_size_;  // how many there are, and where pictures begin
  float plane_distance_;
  GBuffer whole_;
  SharePictures shares_;
  LightMasks masks_;
  gl::Program split_, find_tiles_, join_tiles_, find_middles_, fill_smooth_, cover_amid_;
  std::vector<gl::Program> add_shares_, add_lights_, add_lights_amid_;  // by formula
  gl::Texture planes_, joins_, middles_, stencil_;
  gl::Framebuffer planes_framebuffer_, joins_framebuffer_, middles_framebuffer_;
  std::vector<Round> rounds_;
  std::array<TileQuads, 2> tile_irradiance_;  // what there is, and that with lights more
  std::array<Quads, 2> irradiance_;
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
