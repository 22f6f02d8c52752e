// SPDX-License-Identifier: MIT
#include "lantern/raster/masked_shading.h"

#include "lantern/gl/check.h"

#include <string>
#include <utility>

namespace lantern {
namespace {

gl::Program shade_program(const gl::ShaderFiles& files, LightFormula formula,
                          GLuint lights_binding) {
  gl::Program program = tile_program(files, "shaders/shade_masked.frag.glsl", 1,
                                     {{"KIND", std::to_string(static_cast<int>(formula))}});
  program.set_block("Lights", lights_binding);
  return program;
}

}  // namespace

MaskedShading::MaskedShading(const gl::ShaderFiles& files, int width, int height,
                             GLuint lights_binding)
    : shade_{shade_program(files, LightFormula::kSurface, lights_binding),
             shade_program(files, LightFormula::kPunctual, lights_binding),
             shade_program(files, LightFormula::kDirectional, lights_binding)},
      sums_{QuadTarget(QuadLayout{1, width, height}.size()),
            QuadTarget(QuadLayout{1, width, height}.size())} {}

void MaskedShading::clear() { sums_[0].clear(); }

void MaskedShading::add(const LightGroup& group, const GBuffer& g_buffer, const gl::Texture& mask) {
  const gl::Program& program = shade_[static_cast<std::size_t>(group.formula)];
  program.set("u_points", 0, g_buffer.points);
  program.set("u_reflectances", 1, g_buffer.reflectances);
  program.set("u_mask", 2, mask);
  sums_[0].colours.set_in(program, 3);
  program.set("u_count", static_cast<int>(group.records.size()));
  sums_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(sums_[0], sums_[1]);
  gl::check("shading");
}

}  // namespace lantern
