// SPDX-License-Identifier: MIT
#include "lantern/raster/map_masks.h"

#include "lantern/gl/check.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/draw_state.h"

#include <bit>
#include <string>
#include <vector>

namespace lantern {
namespace {

// As in shaders/map_tiles.glsl.
constexpr int kTile = 4, kGroup = 4 * kTile;

int tiles(int pixels, int tile) { return (pixels + tile - 1) / tile; }

/// The part of a picture of tiles that a part of one of pixels lies in.
View view_of_tiles(View view, int tile) {
  const glm::ivec2 end = view.origin + view.size;
  view.origin /= tile;
  view.size = glm::ivec2(tiles(end.x, tile), tiles(end.y, tile)) - view.origin;
  return view;
}

/// The same of quads, those of a tile side by side.
View view_of_quads(const View& view) {
  View quads = view_of_tiles(view, kTile);
  quads.origin.x *= kTile;
  quads.size.x *= kTile;
  return quads;
}

gl::Texture masks_of_quads(int width, int height) {
  const glm::ivec2 size = QuadLayout{kTile, width, height}.size();
  return {gl::Format::kRgba32ui, size.x, size.y};
}

gl::Program program_of(const gl::ShaderFiles& files, const char* fragment, LightFormula formula,
                       std::vector<gl::Definition> definitions = {}) {
  definitions.push_back({"KIND", std::to_string(static_cast<int>(formula))});
  return gl::Program(files, "shaders/full_screen.vert.glsl", fragment, definitions);
}

}  // namespace

MapMasks::Programs::Programs(const gl::ShaderFiles& files, LightFormula formula)
    : of_groups(program_of(files, "shaders/map_tile_masks.frag.glsl", formula, {{"GROUPS", "1"}})),
      of_tiles(program_of(files, "shaders/map_tile_masks.frag.glsl", formula, {{"GROUPS", "0"}})),
      of_quads(program_of(files, "shaders/map_masks.frag.glsl", formula,
                          {{"TILE", std::to_string(kTile)}})) {}

MapMasks::Tiles::Tiles(int width, int height)
    : spheres(gl::Format::kRgba32ui, width, height),
      normals(gl::Format::kRgba32ui, width, height),
      told(gl::Format::kRg32ui, width, height),
      framebuffer({&spheres, &normals}),
      told_framebuffer({&told}) {}

MapMasks::MapMasks(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height)
    : maps_(maps),
      of_pixels_(files, "shaders/full_screen.vert.glsl", "shaders/map_receivers.frag.glsl"),
      of_tiles_(files, "shaders/full_screen.vert.glsl", "shaders/map_tiles.frag.glsl"),
      of_groups_(files, "shaders/full_screen.vert.glsl", "shaders/map_tile_groups.frag.glsl"),
      take_apart_(tile_program(files, "shaders/map_pixel_masks.frag.glsl", kTile)),
      programs_{Programs(files, LightFormula::kSurface), Programs(files, LightFormula::kPunctual),
                Programs(files, LightFormula::kDirectional)},
      groups_(tiles(width, kGroup), tiles(height, kGroup)),
      tiles_(tiles(width, kTile), tiles(height, kTile)),
      receivers_(gl::Format::kRg32ui, width, height),
      masks_of_quads_(masks_of_quads(width, height)),
      mask_(gl::Format::kRgba8, width, height),
      receiver_framebuffer_({&receivers_}),
      quad_framebuffer_({&masks_of_quads_}),
      mask_framebuffer_({&mask_}) {}

void MapMasks::look_at(const GBuffer& g_buffer) {
  of_pixels_.set("u_emissions", 0, g_buffer.emissions);
  of_pixels_.set("u_patches", 1, maps_.triangles().owners);
  receiver_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  of_tiles_.set("u_points", 0, g_buffer.points);
  of_tiles_.set("u_receivers", 1, receivers_);
  tiles_.framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  of_groups_.set("u_spheres", 0, tiles_.spheres);
  of_groups_.set("u_normals", 1, tiles_.normals);
  groups_.framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  gl::check("drawing what encloses tiles");
  box_.reset();
}

Bounds MapMasks::bounds_of_tiles() const {
  const std::vector<std::uint32_t> spheres = tiles_.framebuffer.read<std::uint32_t>(0);
  Bounds bounds;
  for (std::size_t i = 0; i < spheres.size(); i += 4) {
    const auto word = [&](std::size_t k) { return std::bit_cast<float>(spheres[i + k]); };
    const float radius = word(3);
    if (radius < 0.0f) continue;  // sky alone
    const Vec3 centre(word(0), word(1), word(2));
    bounds.add(centre - radius);
    bounds.add(centre + radius);
  }
  return bounds;
}

void MapMasks::ask(const gl::Program& program, const Tiles& tiles, const View& view) {
  program.set("u_spheres", 0, tiles.spheres);
  program.set("u_normals", 1, tiles.normals);
  maps_.set_in(program, 2);
  program.set("u_map_blocks", 3, maps_.blocks());
  tiles.told_framebuffer.bind();
  set_viewport(view);
  gl::draw_full_screen(no_vertices_);
}

const gl::Texture& MapMasks::draw(const LightGroup& group, const View& view,
                                  const GBuffer& g_buffer, const gl::Texture& asked,
                                  StageTimes& times) {
  // Only maps from infinity show what is looked at alone; to read it back takes waiting for the
  // GPU.
  if (group.formula == LightFormula::kDirectional && !box_) box_ = bounds_of_tiles();
  maps_.draw(group, box_.value_or(Bounds{}), times);
  times.begin(Stage::kMaps);
  const Programs& programs = programs_[static_cast<std::size_t>(group.formula)];
  programs.of_groups.set("u_count", static_cast<int>(group.records.size()));
  ask(programs.of_groups, groups_, view_of_tiles(view, kGroup));
  programs.of_tiles.set("u_told", 4, groups_.told);
  ask(programs.of_tiles, tiles_, view_of_tiles(view, kTile));

  programs.of_quads.set("u_told", 0, tiles_.told);
  programs.of_quads.set("u_mask", 1, asked);
  programs.of_quads.set("u_points", 2, g_buffer.points);
  programs.of_quads.set("u_receivers", 3, receivers_);
  maps_.set_in(programs.of_quads, 4);
  programs.of_quads.set("u_map_blocks", 5, maps_.blocks());
  programs.of_quads.set("u_map_numbers", 6, maps_.numbers());
  programs.of_quads.set("u_triangles", 7, maps_.triangles().corners);
  quad_framebuffer_.bind();
  set_viewport(view_of_quads(view));
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
