// SPDX-License-Identifier: MIT
// Each pixel of a tile takes its share of the lights, and neighbours on the same surface lend each
// other theirs. [Keller & Heidrich 2001, Interleaved Sampling; Segovia et al. 2006, Non-interleaved
// Deferred Shading of Interleaved Sample Patterns]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/lighting.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lantern {

/// Lights in `shares` sets, each well spread: paths that follow one another are, so every bounce's
/// are cut into runs; which of them a set gets moves on with `turn`. Indices into the lights.
std::vector<std::vector<std::uint32_t>> share_out(const VirtualLights& lights, std::size_t shares,
                                                  std::size_t turn);

/// Every tile-th pixel is a small picture with its share of the lights; Interleaving cuts them out
/// of the whole and brings what their lights give back to all pixels.
class Interleaving {
 public:
  /// `tile` x `tile` pixels take all lights together; `radius` is the scene's.
  Interleaving(const gl::ShaderFiles& files, int width, int height, int tile, float radius);

  /// Of the share's pixels the depth that `whole` has or, if asked for, all.
  void split(const GBuffer& whole, const View& of_share, const GBuffer& share, bool all) const;
  /// Forgets all lights. No share will have more groups of them than this.
  void begin(std::size_t rounds);
  /// A group of lights of this share was done, the first, the next, ...
  void take(const glm::ivec2& share, std::size_t number_of_group, const LightGroup& group,
            const Lighting& done);
  /// All were, or none more will be.
  void end(const glm::ivec2& share, const MaskedShading& irradiance);

  /// The irradiance of all pixels by all lights, in W/m².
  void filter(const GBuffer& whole, const View& view);
  /// For shaders/resolve.frag.glsl, on three texture units from `unit` on.
  void set_irradiance(const gl::Program& program, int unit) const;
  /// What its shaders, and those that read its irradiance, are defined with.
  static std::vector<gl::Definition> definitions(int tile);

 private:
  /// Red, green and blue of up to four pixels of a row a texel.
  struct Quads {
    gl::Texture red, green, blue;
    gl::Framebuffer framebuffer;
    Quads(int width, int height, const gl::Texture* stencil);
    void set_in(const gl::Program& program, int unit) const;
  };
  /// One group of each share. The last round's shares have the irradiance by all groups.
  struct Round {
    gl::Texture shares, masks;
    std::vector<std::optional<LightGroup>> groups;
    Round(const glm::ivec2& size, int tile);
  };

  /// As many lights of a round and a formula as go into one uniform block.
  struct Pass {
    const Round* round;
    LightFormula formula;
    std::vector<LightRecord> lights;
    std::vector<glm::uvec2> of_shares;  // the first of each share's, how many
  };

  std::size_t number(const glm::ivec2& share) const;
  /// Where its picture stands among the others.
  glm::ivec2 corner(const glm::ivec2& share) const;
  static void append_passes(const Round& round, LightFormula formula, std::vector<Pass>& passes);
  /// What these lights give where tiles are not smooth.
  void add(const GBuffer& whole, const Pass& pass, bool first);

  int tile_;
  float plane_distance_;
  gl::Program split_, find_tiles_, join_tiles_, add_rows_, add_columns_;
  std::vector<gl::Program> add_lights_;  // by formula
  gl::Texture tiles_, joins_, of_shares_, stencil_;
  gl::Buffer lights_;
  gl::Framebuffer tile_framebuffer_, join_framebuffer_;
  std::vector<Round> rounds_;
  Quads rows_;
  std::array<Quads, 2> irradiance_;  // what there is, and that with lights more
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
