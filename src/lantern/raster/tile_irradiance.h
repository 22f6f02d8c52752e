// SPDX-License-Identifier: MIT
// G-buffer -> which tiles are parts of one plane; and rounds of lights -> irradiance in the middles
// of those tiles, and whether it varies too much to stand for their pixels.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/light_round.h"
#include "lantern/raster/surfaces.h"

#include <array>
#include <vector>

namespace lantern {

class TileIrradiance {
 public:
  /// Of tiles of `tile` x `tile` pixels, `columns` by `rows` of them. What is further off a plane
  /// is another surface.
  TileIrradiance(const gl::ShaderFiles& files, int tile, int columns, int rows,
                 float plane_distance);

  /// A fragment makes so many tiles of a row.
  static constexpr int kTilesOfQuad = 4;

  /// The surfaces that the next rounds are for.
  void look_at(const GBuffer& picture);
  /// And what this round's lights give.
  void add(const LightRound& round, bool is_first);
  /// See shaders/interleaved_middles.frag.glsl; until the next look_at().
  const gl::Texture& find_middles();

 private:
  /// Of four tiles a texel, and how much of that changes around.
  struct Quads {
    ColourQuads colours;
    gl::Texture changes;
    gl::Framebuffer framebuffer;
    Quads(int width, int height);
    void set_in(const gl::Program& program, int unit) const;
  };

  float plane_distance_;
  gl::Program find_planes_, join_, find_middles_;
  std::vector<gl::Program> add_;  // by formula
  gl::Texture planes_, joins_, middles_;
  gl::Framebuffer planes_framebuffer_, joins_framebuffer_, middles_framebuffer_;
  std::array<Quads, 2> irradiance_;  // what there is, and that with lights more
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
