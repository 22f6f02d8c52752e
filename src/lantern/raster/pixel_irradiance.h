// SPDX-License-Identifier: MIT
// Irradiance in the middles of tiles, G-buffer, rounds of lights -> irradiance of all pixels: from
// the middles where tiles are smooth, by every light elsewhere.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/light_round.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <array>
#include <span>
#include <vector>

namespace lantern {

class PixelIrradiance {
 public:
  /// Of pictures of this size, in tiles of `tile` x `tile` pixels. What is further off a plane is
  /// another surface.
  PixelIrradiance(const gl::ShaderFiles& files, int tile, int width, int height,
                  float plane_distance);

  /// `middles`: see TileIrradiance. No rounds: no light.
  void fill(const gl::Texture& middles, const GBuffer& picture, const View& view,
            std::span<const LightRound> rounds);
  /// In W/m².
  const ColourQuads& irradiance() const { return irradiance_[0].colours; }

 private:
  void add(const LightRound& round, bool is_first, const GBuffer& picture, const View& view);

  float plane_distance_;
  gl::Program cover_amid_, fill_smooth_;
  std::vector<gl::Program> add_, add_amid_;  // by formula
  QuadLayout layout_;
  gl::Texture stencil_;
  std::array<QuadTarget, 2> irradiance_;  // what there is, and that with lights more
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
