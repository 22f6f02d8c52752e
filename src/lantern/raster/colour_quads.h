// SPDX-License-Identifier: MIT
// Red, green and blue of up to four neighbours of a row a texel: shaders/colour_quads.glsl.
#pragma once

#include "lantern/core/math.h"
#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"

#include <glm/vec2.hpp>

#include <vector>

namespace lantern {

/// Covers the framebuffer; its fragments are pixels, tiles of `tile` x `tile` or quads of either.
gl::Program tile_program(const gl::ShaderFiles& files, const char* fragment, int tile,
                         const std::vector<gl::Definition>& more = {});

/// Which quads the pixels of a picture are in, in tiles of `tile` x `tile`.
struct QuadLayout {
  int tile, width, height;

  int columns() const { return tile == 2 ? 2 : 4; }  // of a quad
  /// Of the picture of quads.
  glm::ivec2 size() const {
    return {(width + columns() - 1) / columns() * tile, (height + tile - 1) / tile};
  }
  glm::ivec2 quad_of(const glm::ivec2& pixel) const {
    return {pixel.x / columns() * tile + pixel.y % tile, pixel.y / tile};
  }
};

struct ColourQuads {
  gl::Texture red, green, blue;

  explicit ColourQuads(const glm::ivec2& size)
      : red(gl::Format::kRgba32f, size.x, size.y),
        green(gl::Format::kRgba32f, size.x, size.y),
        blue(gl::Format::kRgba32f, size.x, size.y) {}

  /// On so many texture units from `unit` on.
  static constexpr int kUnits = 3;
  void set_in(const gl::Program& program, int unit) const {
    program.set("u_red", unit, red);
    program.set("u_green", unit + 1, green);
    program.set("u_blue", unit + 2, blue);
  }
};

/// Quads that one draws into.
struct QuadTarget {
  ColourQuads colours;
  gl::Framebuffer framebuffer;

  explicit QuadTarget(const glm::ivec2& size, const gl::Texture* depth = nullptr);
  /// Black everywhere.
  void clear() const;
  /// The pixels of the picture, row by row.
  std::vector<Rgb> read(const QuadLayout& layout) const;
};

}  // namespace lantern
