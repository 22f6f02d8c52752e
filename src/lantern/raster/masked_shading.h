// SPDX-License-Identifier: MIT
// Adds up what lights give to the pixels that see them, 32 lights at a time, in 32-bit floats.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/surfaces.h"

#include <array>

namespace lantern {

class MaskedShading {
 public:
  /// Of pictures of this size, with lights of the uniform block with this binding.
  MaskedShading(const gl::ShaderFiles& files, int width, int height, GLuint lights_binding);

  /// No light.
  void clear();
  /// And what the lights of the mask's bits give.
  void add(const LightGroup& group, const GBuffer& g_buffer, const gl::Texture& mask);
  /// In W/m².
  const QuadTarget& irradiance() const { return sums_[0]; }

 private:
  std::array<gl::Program, kLightFormulas> shade_;
  std::array<QuadTarget, 2> sums_;  // what there is, and that with a group of lights more
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
