// SPDX-License-Identifier: MIT
#include "lantern/raster/tile_irradiance.h"

#include "lantern/gl/check.h"

#include <utility>

namespace lantern {

TileIrradiance::Quads::Quads(int width, int height)
    : colours({width, height}),
      changes(gl::Format::kRgba32f, width, height),
      framebuffer({&colours.red, &colours.green, &colours.blue, &changes}) {}

void TileIrradiance::Quads::set_in(const gl::Program& program, int unit) const {
  colours.set_in(program, unit);
  program.set("u_changes", unit + ColourQuads::kUnits, changes);
}

TileIrradiance::TileIrradiance(const gl::ShaderFiles& files, int tile, int columns, int rows,
                               float plane_distance)
    : plane_distance_(plane_distance),
      find_planes_(tile_program(files, "shaders/interleaved_tiles.frag.glsl", tile)),
      join_(tile_program(files, "shaders/interleaved_joins.frag.glsl", tile)),
      find_middles_(tile_program(files, "shaders/interleaved_middles.frag.glsl", tile)),
      add_(LightRound::programs(files, "shaders/interleaved_shares.frag.glsl", tile)),
      planes_(gl::Format::kRgba32ui, columns, rows),
      joins_(gl::Format::kR32ui, columns, rows),
      middles_(gl::Format::kRgba32ui, columns, rows),
      planes_framebuffer_({&planes_}),
      joins_framebuffer_({&joins_}),
      middles_framebuffer_({&middles_}),
      irradiance_{Quads((columns + kTilesOfQuad - 1) / kTilesOfQuad, rows),
                  Quads((columns + kTilesOfQuad - 1) / kTilesOfQuad, rows)} {}

void TileIrradiance::look_at(const GBuffer& picture) {
  find_planes_.set("u_plane_distance", plane_distance_);
  find_planes_.set("u_points", 0, picture.points);
  find_planes_.set("u_reflectances", 1, picture.reflectances);
  planes_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  join_.set("u_plane_distance", plane_distance_);
  join_.set("u_tiles", 0, planes_);
  joins_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  gl::check("finding planes");
}

void TileIrradiance::add(const LightRound& round, bool is_first) {
  const gl::Program& program = round.use(add_, is_first);
  program.set("u_tiles", LightRound::kUnits, planes_);
  program.set("u_joins", LightRound::kUnits + 1, joins_);
  irradiance_[0].set_in(program, LightRound::kUnits + 2);
  irradiance_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(irradiance_[0], irradiance_[1]);
  gl::check("shading tiles");
}

const gl::Texture& TileIrradiance::find_middles() {
  find_middles_.set("u_tiles", 0, planes_);
  find_middles_.set("u_joins", 1, joins_);
  irradiance_[0].set_in(find_middles_, 2);
  middles_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  gl::check("finding the middles of tiles");
  return middles_;
}

}  // namespace lantern
