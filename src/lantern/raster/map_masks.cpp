// SPDX-License-Identifier: MIT
#include "lantern/raster/map_masks.h"

#include "lantern/gl/check.h"

#include <bit>
#include <string>
#include <vector>

namespace lantern {
namespace {

constexpr int kTile = 4;  // as in shaders/map_tiles.glsl

int tiles(int pixels) { return (pixels + kTile - 1) / kTile; }

gl::Program program_of(const gl::ShaderFiles& files, const char* fragment, LightFormula formula) {
  return gl::Program(files, "shaders/full_screen.vert.glsl", fragment,
                     {{"KIND", std::to_string(static_cast<int>(formula))}});
}

}  // namespace

MapMasks::Programs::Programs(const gl::ShaderFiles& files, LightFormula formula)
    : of_tiles(program_of(files, "shaders/map_tile_masks.frag.glsl", formula)),
      of_pixels(program_of(files, "shaders/map_masks.frag.glsl", formula)) {}

MapMasks::MapMasks(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height)
    : maps_(maps),
      owners_(files, "shaders/full_screen.vert.glsl", "shaders/map_owners.frag.glsl"),
      tiles_(files, "shaders/full_screen.vert.glsl", "shaders/map_tiles.frag.glsl"),
      programs_{Programs(files, LightFormula::kSurface), Programs(files, LightFormula::kPunctual),
                Programs(files, LightFormula::kDirectional)},
      owner_(gl::Format::kRgba32ui, width, height),
      spheres_(gl::Format::kRgba32ui, tiles(width), tiles(height)),
      normals_(gl::Format::kRgba32ui, tiles(width), tiles(height)),
      told_(gl::Format::kRg32ui, tiles(width), tiles(height)),
      mask_(gl::Format::kRgba8, width, height),
      owner_framebuffer_({&owner_}),
      tile_framebuffer_({&spheres_, &normals_}),
      told_framebuffer_({&told_}),
      mask_framebuffer_({&mask_}) {}

void MapMasks::look_at(const GBuffer& g_buffer) {
  owners_.set("u_emissions", 0, g_buffer.emissions);
  owners_.set("u_reflectances", 1, g_buffer.reflectances);
  owners_.set("u_patches", 2, maps_.triangles().owners);
  owners_.set("u_triangles", 3, maps_.triangles().corners);
  owner_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  tiles_.set("u_points", 0, g_buffer.points);
  tiles_.set("u_reflectances", 1, g_buffer.reflectances);
  tiles_.set("u_owners", 2, owner_);
  tiles_.set("u_emissions", 3, g_buffer.emissions);
  tile_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  gl::check("drawing what encloses tiles");
  receivers_.reset();
}

Bounds MapMasks::bounds_of_tiles() const {
  const std::vector<std::uint32_t> spheres = tile_framebuffer_.read<std::uint32_t>(0);
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

const gl::Texture& MapMasks::draw(const LightGroup& group, const GBuffer& g_buffer,
                                  const gl::Texture& asked, StageTimes& times) {
  // Only maps from infinity show what is looked at alone; to read it back takes waiting for the
  // GPU.
  if (group.formula == LightFormula::kDirectional && !receivers_) receivers_ = bounds_of_tiles();
  maps_.draw(group, receivers_.value_or(Bounds{}), times);
  times.begin(Stage::kMaps);
  const Programs& programs = programs_[static_cast<std::size_t>(group.formula)];
  programs.of_tiles.set("u_spheres", 0, spheres_);
  programs.of_tiles.set("u_normals", 1, normals_);
  programs.of_tiles.set("u_count", static_cast<int>(group.records.size()));
  maps_.set_in(programs.of_tiles, 2);
  programs.of_tiles.set("u_map_cells", 4, maps_.cells());
  told_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);

  programs.of_pixels.set("u_points", 0, g_buffer.points);
  programs.of_pixels.set("u_reflectances", 1, g_buffer.reflectances);
  programs.of_pixels.set("u_owners", 2, owner_);
  programs.of_pixels.set("u_told", 3, told_);
  programs.of_pixels.set("u_mask", 4, asked);
  maps_.set_in(programs.of_pixels, 5);
  programs.of_pixels.set("u_map_numbers", 7, maps_.numbers());
  programs.of_pixels.set("u_triangles", 8, maps_.triangles().corners);
  mask_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  times.end();
  gl::check("asking maps");
  return mask_;
}

}  // namespace lantern
