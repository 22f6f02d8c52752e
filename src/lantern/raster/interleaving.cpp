// SPDX-License-Identifier: MIT
#include "lantern/raster/interleaving.h"

#include "lantern/gl/check.h"

#include <algorithm>
#include <string>

namespace lantern {

std::vector<std::vector<std::uint32_t>> share_out(const VirtualLights& lights, std::size_t shares,
                                                  std::size_t turn) {
  std::vector<std::size_t> of_bounce;  // how many lights
  for (const std::uint32_t bounce : lights.bounce) {
    of_bounce.resize(std::max<std::size_t>(of_bounce.size(), bounce + 1));
    ++of_bounce[bounce];
  }
  std::vector<std::vector<std::uint32_t>> sets(shares);
  std::vector<std::size_t> seen(of_bounce.size(), 0), start(of_bounce.size(), turn);
  for (std::size_t b = 1; b < start.size(); ++b) start[b] = start[b - 1] + of_bounce[b - 1];
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const std::uint32_t bounce = lights.bounce[i];
    const std::size_t run = seen[bounce]++ * shares / of_bounce[bounce];
    sets[(start[bounce] + run) % shares].push_back(i);
  }
  return sets;
}

Interleaving::Interleaving(const gl::ShaderFiles& files, int width, int height, int tile,
                           float radius)
    : tile_(tile),
      radius_(radius),
      add_rows_(files, "shaders/full_screen.vert.glsl", "shaders/interleaved_rows.frag.glsl",
                {{"TILE", std::to_string(tile)}}),
      filter_(files, "shaders/full_screen.vert.glsl", "shaders/interleaved.frag.glsl",
              {{"TILE", std::to_string(tile)}}),
      shares_(gl::Format::kRgba32f, (width + tile - 1) / tile * tile,
              (height + tile - 1) / tile * tile),
      rows_(gl::Format::kRgba32f, width, height),
      irradiance_(gl::Format::kRgba32f, width, height) {}

void Interleaving::take(const Target& irradiance, int x, int y) {
  const int columns = shares_.width() / tile_, rows = shares_.height() / tile_;
  irradiance.framebuffer.bind();
  shares_.bind(0);
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, x * columns, y * rows, 0, 0, columns, rows);
  gl::check("copying a share of the lights");
}

const Target& Interleaving::filter(const GBuffer& g_buffer) {
  // A tile sees about this much of a surface; further off its plane is another one.
  constexpr float kSamePlane = 1e-2f;
  const auto run = [&](const gl::Program& program, const Target& target) {
    program.set("u_points", 0, g_buffer.points);
    program.set("u_reflectances", 1, g_buffer.reflectances);
    program.set("u_shares", 2, shares_);
    program.set("u_plane_distance", kSamePlane * radius_);
    target.framebuffer.bind();
    gl::draw_full_screen(no_vertices_);
  };
  run(add_rows_, rows_);
  filter_.set("u_rows", 3, rows_.texture);
  run(filter_, irradiance_);
  gl::check("filtering");
  return irradiance_;
}

}  // namespace lantern
