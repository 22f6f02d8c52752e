// SPDX-License-Identifier: MIT
#include "lantern/raster/colour_quads.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace lantern {

gl::Program tile_program(const gl::ShaderFiles& files, const char* fragment, int tile,
                         const std::vector<gl::Definition>& more) {
  std::vector<gl::Definition> definitions = {{"TILE", std::to_string(tile)}};
  definitions.insert(definitions.end(), more.begin(), more.end());
  return gl::Program(files, "shaders/full_screen.vert.glsl", fragment, definitions);
}

QuadTarget::QuadTarget(const glm::ivec2& size, const gl::Texture* depth)
    : colours(size), framebuffer({&colours.red, &colours.green, &colours.blue}, depth) {}

void QuadTarget::clear() const {
  framebuffer.bind();
  const float none[4] = {};
  for (int colour = 0; colour < 3; ++colour) glClearBufferfv(GL_COLOR, colour, none);
}

std::vector<Rgb> QuadTarget::read(const QuadLayout& layout) const {
  const std::array channels = {framebuffer.read<float>(0), framebuffer.read<float>(1),
                               framebuffer.read<float>(2)};
  std::vector<Rgb> pixels;
  pixels.reserve(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height));
  const int columns = layout.columns(), quads_of_row = layout.size().x;
  for (int y = 0; y < layout.height; ++y) {
    for (int x = 0; x < layout.width; x += columns) {
      const glm::ivec2 quad = layout.quad_of({x, y});
      const auto first = static_cast<std::size_t>(4 * (quad.y * quads_of_row + quad.x));
      const auto count = static_cast<std::size_t>(std::min(columns, layout.width - x));
      for (std::size_t i = first; i < first + count; ++i) {
        pixels.emplace_back(channels[0][i], channels[1][i], channels[2][i]);
      }
    }
  }
  return pixels;
}

}  // namespace lantern
