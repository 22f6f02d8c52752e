// SPDX-License-Identifier: MIT
// Red, green and blue of up to four neighbours of a row a texel: shaders/colour_quads.glsl.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"

namespace lantern {

struct ColourQuads {
  gl::Texture red, green, blue;

  ColourQuads(int width, int height)
      : red(gl::Format::kRgba32f, width, height),
        green(gl::Format::kRgba32f, width, height),
        blue(gl::Format::kRgba32f, width, height) {}

  /// On so many texture units from `unit` on.
  static constexpr int kUnits = 3;
  void set_in(const gl::Program& program, int unit) const {
    program.set("u_red", unit, red);
    program.set("u_green", unit + 1, green);
    program.set("u_blue", unit + 2, blue);
  }
};

}  // namespace lantern
