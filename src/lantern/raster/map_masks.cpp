// SPDX-License-Identifier: MIT
#include "lantern/raster/map_masks.h"

#include "lantern/gl/check.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/draw_state.h"

#include <string>

namespace lantern {
namespace {

constexpr int kTile = MapTiles::kTile;

/// The part of a picture of quads in which those of the view are.
View part_of_quads(const View& view) {
  View quads = MapTiles::part_of(view);
  quads.origin.x *= kTile;
  quads.size.x *= kTile;
  return quads;
}

gl::Texture masks_of_quads(int width, int height) {
  const glm::ivec2 size = QuadLayout{kTile, width, height}.size();
  return {gl::Format::kRgba32ui, size.x, size.y};
}

}  // namespace

MapMasks::MapMasks(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height)
    : tiles_(maps, files, width, height),
      take_apart_(tile_program(files, "shaders/map_pixel_masks.frag.glsl", kTile)),
      masks_of_quads_(masks_of_quads(width, height)),
      mask_(gl::Format::kRgba8, width, height),
      quad_framebuffer_({&masks_of_quads_}),
      mask_framebuffer_({&mask_}) {
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    ask_quads_.push_back(tile_program(files, "shaders/map_masks.frag.glsl", kTile,
                                      {{"KIND", std::to_string(formula)}, {"ASKED", "1"}}));
  }
}

const gl::Texture& MapMasks::draw(const LightGroup& group, const View& view,
                                  const GBuffer& g_buffer, const gl::Texture& asked,
                                  StageTimes& times) {
  tiles_.ask(group, view, times);
  times.begin(Stage::kMaps);
  const gl::Program& program = ask_quads_[static_cast<std::size_t>(group.formula)];
  program.set("u_points", 0, g_buffer.points);
  program.set("u_mask", 1, asked);
  tiles_.set_in(program, 2);
  quad_framebuffer_.bind();
  set_viewport(part_of_quads(view));
  gl::draw_full_screen(no_vertices_);
  take_apart_.set("u_masks", 0, masks_of_quads_);
  mask_framebuffer_.bind();
  set_viewport(view);
  gl::draw_full_screen(no_vertices_);
  times.end();
  gl::check("asking maps");
  return mask_;
}

}  // namespace lantern
