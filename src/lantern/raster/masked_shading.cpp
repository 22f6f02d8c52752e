// SPDX-License-Identifier: MIT
#include "lantern/raster/masked_shading.h"

#include "lantern/gl/check.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lantern {
namespace {

constexpr std::array kSums = {"u_sum_0", "u_sum_1", "u_sum_2", "u_sum_3"};

gl::Program shade_program(const gl::ShaderFiles& files, LightFormula formula,
                          GLuint lights_binding) {
  gl::Program program(files, "shaders/full_screen.vert.glsl", "shaders/shade_masked.frag.glsl",
                      {{"KIND", std::to_string(static_cast<int>(formula))}});
  program.set_block("Lights", lights_binding);
  return program;
}

}  // namespace

MaskedShading::Strips::Strips(int width, int rows)
    : textures{gl::Texture(gl::Format::kRgba32ui, width, rows),
               gl::Texture(gl::Format::kRgba32ui, width, rows),
               gl::Texture(gl::Format::kRgba32ui, width, rows),
               gl::Texture(gl::Format::kRgba32ui, width, rows)},
      framebuffer({&textures[0], &textures[1], &textures[2], &textures[3]}) {}

MaskedShading::MaskedShading(const gl::ShaderFiles& files, int width, int height,
                             GLuint lights_binding)
    : width_(width),
      height_(height),
      rows_((height + kStrips - 1) / kStrips),
      shade_{shade_program(files, LightFormula::kSurface, lights_binding),
             shade_program(files, LightFormula::kPunctual, lights_binding),
             shade_program(files, LightFormula::kDirectional, lights_binding)},
      sums_{Strips(width_, rows_), Strips(width_, rows_)} {}

void MaskedShading::clear() {
  sums_[0].framebuffer.bind();
  const GLuint none[4] = {};
  for (int strip = 0; strip < kStrips; ++strip) glClearBufferuiv(GL_COLOR, strip, none);
}

void MaskedShading::add(const LightGroup& group, const GBuffer& g_buffer, const gl::Texture& mask) {
  const gl::Program& program = shade_[static_cast<std::size_t>(group.formula)];
  program.set("u_points", 0, g_buffer.points);
  program.set("u_reflectances", 1, g_buffer.reflectances);
  program.set("u_mask", 2, mask);
  for (int strip = 0; strip < kStrips; ++strip) {
    const auto i = static_cast<std::size_t>(strip);
    program.set(kSums[i], 3 + strip, sums_[0].textures[i]);
  }
  program.set("u_count", static_cast<int>(group.records.size()));
  sums_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(sums_[0], sums_[1]);
  gl::check("shading");
}

void MaskedShading::copy_to(const gl::Texture& irradiance) const {
  sums_[0].framebuffer.bind();
  irradiance.bind(0);
  for (int strip = 0; strip < kStrips; ++strip) {
    const int rows = std::min(rows_, height_ - strip * rows_);
    if (rows <= 0) break;
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(strip));
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, strip * rows_, 0, 0, width_, rows);
  }
  gl::check("joining strips");
}

}  // namespace lantern
