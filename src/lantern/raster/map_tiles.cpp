// SPDX-License-Identifier: MIT
#include "lantern/raster/map_tiles.h"

#include "lantern/gl/check.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/draw_state.h"

#include <bit>
#include <string>

namespace lantern {
namespace {

constexpr int kTilesInGroup = 4;  // a side
constexpr int kGroup = kTilesInGroup * MapTiles::kTile;

int tiles(int pixels, int tile) { return (pixels + tile - 1) / tile; }

gl::Program program_for_tiles(const gl::ShaderFiles& files, const char* fragment,
                              std::vector<gl::Definition> definitions = {}) {
  definitions.push_back({"TILES_IN_GROUP", std::to_string(kTilesInGroup)});
  return tile_program(files, fragment, MapTiles::kTile, definitions);
}

gl::Program ask_program(const gl::ShaderFiles& files, LightFormula formula, bool groups) {
  return program_for_tiles(
      files, "shaders/map_tile_masks.frag.glsl",
      {{"KIND", std::to_string(static_cast<int>(formula))}, {"GROUPS", groups ? "1" : "0"}});
}

}  // namespace

View MapTiles::part_of(View view, int tile) {
  const glm::ivec2 end = view.origin + view.size;
  view.origin /= tile;
  view.size = glm::ivec2(tiles(end.x, tile), tiles(end.y, tile)) - view.origin;
  return view;
}

MapTiles::Programs::Programs(const gl::ShaderFiles& files, LightFormula formula)
    : of_groups(ask_program(files, formula, true)), of_tiles(ask_program(files, formula, false)) {}

MapTiles::Tiles::Tiles(int width, int height)
    : spheres(gl::Format::kRgba32ui, width, height),
      normals(gl::Format::kRgba32ui, width, height),
      told(gl::Format::kRg32ui, width, height),
      framebuffer({&spheres, &normals}),
      told_framebuffer({&told}) {}

MapTiles::MapTiles(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height)
    : maps_(maps),
      find_receivers_(files, "shaders/full_screen.vert.glsl", "shaders/map_receivers.frag.glsl"),
      find_tiles_(program_for_tiles(files, "shaders/map_tiles.frag.glsl")),
      find_groups_(program_for_tiles(files, "shaders/map_tile_groups.frag.glsl")),
      groups_(tiles(width, kGroup), tiles(height, kGroup)),
      tiles_(tiles(width, kTile), tiles(height, kTile)),
      receivers_(gl::Format::kRg32ui, width, height),
      receiver_framebuffer_({&receivers_}) {
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    programs_.emplace_back(files, static_cast<LightFormula>(formula));
  }
}

void MapTiles::look_at(const GBuffer& g_buffer) {
  find_receivers_.set("u_emissions", 0, g_buffer.emissions);
  find_receivers_.set("u_patches", 1, maps_.triangles().owners);
  receiver_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  find_tiles_.set("u_points", 0, g_buffer.points);
  find_tiles_.set("u_receivers", 1, receivers_);
  tiles_.framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  find_groups_.set("u_spheres", 0, tiles_.spheres);
  find_groups_.set("u_normals", 1, tiles_.normals);
  groups_.framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  gl::check("drawing what encloses tiles");
  box_.reset();
}

Bounds MapTiles::bounds_of_tiles() const {
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

void MapTiles::ask(const gl::Program& program, const Tiles& tiles, const View& part) {
  program.set("u_spheres", 0, tiles.spheres);
  program.set("u_normals", 1, tiles.normals);
  maps_.set_in(program, 2);
  program.set("u_map_blocks", 3, maps_.blocks());
  tiles.told_framebuffer.bind();
  set_viewport(part);
  gl::draw_full_screen(no_vertices_);
}

void MapTiles::ask(const LightGroup& group, const View& view, StageTimes& times) {
  // Only maps from infinity show what is looked at alone; to read it back takes waiting for the
  // GPU.
  if (group.formula == LightFormula::kDirectional && !box_) box_ = bounds_of_tiles();
  maps_.draw(group, box_.value_or(Bounds{}), times);
  times.begin(Stage::kMaps);
  const Programs& programs = programs_[static_cast<std::size_t>(group.formula)];
  programs.of_groups.set("u_count", static_cast<int>(group.records.size()));
  ask(programs.of_groups, groups_, part_of(view, kGroup));
  programs.of_tiles.set("u_told", 4, groups_.told);
  ask(programs.of_tiles, tiles_, part_of(view));
  times.end();
  gl::check("asking maps for tiles");
}

void MapTiles::set_in(const gl::Program& program, int unit) const {
  program.set("u_told", unit, tiles_.told);
  program.set("u_receivers", unit + 1, receivers_);
  maps_.set_in(program, unit + 2);
  program.set("u_map_blocks", unit + 3, maps_.blocks());
  program.set("u_map_numbers", unit + 4, maps_.numbers());
  program.set("u_triangles", unit + 5, maps_.triangles().corners);
}

}  // namespace lantern
