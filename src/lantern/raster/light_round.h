// SPDX-License-Identifier: MIT
// A group of lights of each pixel of a tile, which of them the pixels see, and the programs that
// read both: see shaders/interleaved_masks.glsl.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/light_masks.h"
#include "lantern/raster/raster_lights.h"

#include <span>
#include <vector>

namespace lantern {

struct LightRound {
  MaskPicture masks;  // of the pictures of all shares
  gl::Texture lights_of;
  gl::Buffer lights;
  LightFormula formula = LightFormula::kSurface;

  /// Of pictures with this depth and stencil, which must outlive it.
  LightRound(const gl::Texture& depth, int shares);

  /// Groups of different shares and one formula, at most kLightsInRound together.
  void hold(std::span<const LightGroup> groups);

  /// One program for each formula.
  static std::vector<gl::Program> programs(const gl::ShaderFiles& files, const char* fragment,
                                           int tile, const std::vector<gl::Definition>& more = {});
  /// Chooses the one for these lights and sets what it reads of them, on units below kUnits.
  /// `is_first`: there is no irradiance to add to.
  const gl::Program& use(const std::vector<gl::Program>& programs, bool is_first) const;
  static constexpr int kUnits = 2;
};

}  // namespace lantern
