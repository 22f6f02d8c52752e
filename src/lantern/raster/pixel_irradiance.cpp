// SPDX-License-Identifier: MIT
#include "lantern/raster/pixel_irradiance.h"

#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"

#include <utility>

namespace lantern {
namespace {

/// What the stencil tells of quads of pixels.
constexpr int kRough = 0, kRoughAmidPlane = 1, kSmooth = 2;

constexpr const char* kLights = "shaders/interleaved_lights.frag.glsl";

}  // namespace

PixelIrradiance::PixelIrradiance(const gl::ShaderFiles& files, int tile, int width, int height,
                                 float plane_distance)
    : plane_distance_(plane_distance),
      cover_amid_(tile_program(files, "shaders/interleaved_amid.frag.glsl", tile)),
      fill_smooth_(tile_program(files, "shaders/interleaved_smooth.frag.glsl", tile)),
      add_(LightRound::programs(files, kLights, tile, {{"AMID_PLANE", "0"}})),
      add_amid_(LightRound::programs(files, kLights, tile, {{"AMID_PLANE", "1"}})),
      layout_{tile, width, height},
      stencil_(gl::Format::kDepth32fStencil8, layout_.size().x, layout_.size().y),
      irradiance_{QuadTarget(layout_.size(), &stencil_), QuadTarget(layout_.size(), &stencil_)} {}

void PixelIrradiance::add(const LightRound& round, bool is_first, const GBuffer& picture,
                          const View& view) {
  irradiance_[1].framebuffer.bind();
  for (const int part : {kRough, kRoughAmidPlane}) {
    const gl::Program& program = round.use(part == kRough ? add_ : add_amid_, is_first);
    if (part == kRough) program.set("u_plane_distance", plane_distance_);
    program.set("u_points", LightRound::kUnits, picture.points);
    program.set("u_reflectances", LightRound::kUnits + 1, picture.reflectances);
    irradiance_[0].colours.set_in(program, LightRound::kUnits + 2);
    apply({.stencil = StencilUse::kMatch, .reference = part}, view);
    gl::draw_full_screen(no_vertices_);
  }
  std::swap(irradiance_[0], irradiance_[1]);
}

void PixelIrradiance::fill(const gl::Texture& middles, const GBuffer& picture, const View& view,
                           std::span<const LightRound> rounds) {
  if (rounds.empty()) {
    irradiance_[0].clear();
    return;
  }
  // Into what the last of the rounds will draw into.
  irradiance_[rounds.size() % 2].framebuffer.bind();
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(view), kRough);
  apply({.stencil = StencilUse::kMark, .reference = kRoughAmidPlane, .colour = false}, view);
  cover_amid_.set("u_middles", 0, middles);
  gl::draw_full_screen(no_vertices_);
  apply({.stencil = StencilUse::kMark, .reference = kSmooth}, view);
  fill_smooth_.set("u_middles", 0, middles);
  gl::draw_full_screen(no_vertices_);
  for (const LightRound& round : rounds) add(round, &round == &rounds.front(), picture, view);
  reset_draw_state();
  gl::check("filling pixels");
}

}  // namespace lantern
