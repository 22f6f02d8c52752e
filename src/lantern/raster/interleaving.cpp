// SPDX-License-Identifier: MIT
#include "lantern/raster/interleaving.h"

#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"

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

namespace {

constexpr GLuint kLightsBinding = 0;
/// As many as every GL has room for in a uniform block.
constexpr std::size_t kLightsInBlock = 16384 / sizeof(LightRecord);

int in_tiles(int pixels, int tile) { return (pixels + tile - 1) / tile; }

/// Pixels of a row that a fragment makes.
int columns_of(int tile) { return std::min(tile, 4); }

gl::Program program_of(const gl::ShaderFiles& files, const char* fragment, int tile) {
  return gl::Program(files, "shaders/full_screen.vert.glsl", fragment,
                     Interleaving::definitions(tile));
}

}  // namespace

std::vector<gl::Definition> Interleaving::definitions(int tile) {
  return {{"TILE", std::to_string(tile)}};
}

Interleaving::Quads::Quads(int width, int height, const gl::Texture* stencil)
    : red(gl::Format::kRgba32f, width, height),
      green(gl::Format::kRgba32f, width, height),
      blue(gl::Format::kRgba32f, width, height),
      framebuffer({&red, &green, &blue}, stencil) {}

void Interleaving::Quads::set_in(const gl::Program& program, int unit) const {
  program.set("u_red", unit, red);
  program.set("u_green", unit + 1, green);
  program.set("u_blue", unit + 2, blue);
}

Interleaving::Round::Round(const glm::ivec2& size, int tile)
    : shares(gl::Format::kRgba32ui, size.x, size.y),
      masks(gl::Format::kRgba8, size.x, size.y),
      groups(static_cast<std::size_t>(tile * tile)) {}

// A tile sees about a hundredth of the scene; further off its plane is another surface.
Interleaving::Interleaving(const gl::ShaderFiles& files, int width, int height, int tile,
                           float radius)
    : tile_(tile),
      plane_distance_(1e-2f * radius),
      split_(program_of(files, "shaders/interleaved_split.frag.glsl", tile)),
      find_tiles_(program_of(files, "shaders/interleaved_tiles.frag.glsl", tile)),
      join_tiles_(program_of(files, "shaders/interleaved_joins.frag.glsl", tile)),
      add_rows_(program_of(files, "shaders/interleaved_rows.frag.glsl", tile)),
      add_columns_(program_of(files, "shaders/interleaved_columns.frag.glsl", tile)),
      tiles_(gl::Format::kRgba32ui, in_tiles(width, tile), in_tiles(height, tile)),
      joins_(gl::Format::kR32ui, tiles_.width(), tiles_.height()),
      of_shares_(gl::Format::kRg32ui, tile * tile, 1),
      stencil_(gl::Format::kDepth32fStencil8, in_tiles(width, columns_of(tile)) * tile,
               tiles_.height()),
      lights_(std::span<const LightRecord>()),
      tile_framebuffer_({&tiles_}),
      join_framebuffer_({&joins_}),
      rows_(stencil_.width(), stencil_.height(), nullptr),
      irradiance_{Quads(stencil_.width(), stencil_.height(), &stencil_),
                  Quads(stencil_.width(), stencil_.height(), &stencil_)} {
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    std::vector<gl::Definition> with = definitions(tile);
    with.push_back({"KIND", std::to_string(formula)});
    with.push_back({"LIGHTS", std::to_string(kLightsInBlock)});
    add_lights_.emplace_back(files, "shaders/full_screen.vert.glsl",
                             "shaders/interleaved_lights.frag.glsl", with);
    add_lights_.back().set_block("Lights", kLightsBinding);
  }
}

void Interleaving::split(const GBuffer& whole, const View& of_share, const GBuffer& share,
                         bool all) const {
  share.framebuffer.bind();
  apply({.depth = DepthUse::kReplace, .colour = all}, of_share);
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(of_share), 0);
  split_.set("u_points", 0, whole.points);
  split_.set("u_reflectances", 1, whole.reflectances);
  split_.set("u_emissions", 2, whole.emissions);
  split_.set("u_depth", 3, whole.depth);
  split_.set("u_first", of_share.first);
  gl::draw_full_screen(no_vertices_);
  reset_draw_state();
  gl::check("splitting");
}

void Interleaving::begin(std::size_t rounds) {
  rounds = std::max<std::size_t>(rounds, 1);
  while (rounds_.size() > rounds) rounds_.pop_back();
  while (rounds_.size() < rounds) {
    rounds_.emplace_back(tile_ * glm::ivec2(tiles_.width(), tiles_.height()), tile_);
  }
  for (Round& round : rounds_) {
    std::fill(round.groups.begin(), round.groups.end(), std::nullopt);
  }
}

std::size_t Interleaving::number(const glm::ivec2& share) const {
  return static_cast<std::size_t>(share.y * tile_ + share.x);
}

glm::ivec2 Interleaving::corner(const glm::ivec2& share) const {
  return share * glm::ivec2(tiles_.width(), tiles_.height());
}

void Interleaving::take(const glm::ivec2& share, std::size_t number_of_group,
                        const LightGroup& group, const Lighting& done) {
  Round& round = rounds_[number_of_group];
  round.groups[number(share)] = group;
  const glm::ivec2 at = corner(share);
  done.shading().copy_to(round.shares, at.x, at.y);
  const gl::Framebuffer masks({&done.mask()});
  masks.bind();
  round.masks.bind(0);
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, at.x, at.y, 0, 0, tiles_.width(), tiles_.height());
  gl::check("copying a share of the lights");
}

void Interleaving::end(const glm::ivec2& share, const MaskedShading& irradiance) {
  const Round& last = rounds_.back();
  const glm::ivec2 at = corner(share);
  if (!last.groups[number(share)]) irradiance.copy_to(last.shares, at.x, at.y);
}

void Interleaving::append_passes(const Round& round, LightFormula formula,
                                 std::vector<Pass>& passes) {
  const std::size_t shares = round.groups.size();
  Pass* open = nullptr;
  for (std::size_t share = 0; share < shares; ++share) {
    const std::optional<LightGroup>& group = round.groups[share];
    if (!group || group->formula != formula) continue;
    if (!open || open->lights.size() + group->records.size() > kLightsInBlock) {
      passes.push_back({.round = &round, .formula = formula, .lights = {}, .of_shares = {}});
      open = &passes.back();
      open->of_shares.resize(shares);
    }
    open->of_shares[share] = {open->lights.size(), group->records.size()};
    open->lights.insert(open->lights.end(), group->records.begin(), group->records.end());
  }
}

void Interleaving::add(const GBuffer& whole, const Pass& pass, bool first) {
  std::vector<LightRecord> lights = pass.lights;
  lights.resize(kLightsInBlock);
  lights_.write(std::span<const LightRecord>(lights));
  lights_.bind_as_uniforms(kLightsBinding);
  of_shares_.write(std::span<const std::uint32_t>(&pass.of_shares[0].x, 2 * pass.of_shares.size()));
  const gl::Program& program = add_lights_[static_cast<std::size_t>(pass.formula)];
  program.set("u_plane_distance", plane_distance_);
  program.set("u_points", 0, whole.points);
  program.set("u_reflectances", 1, whole.reflectances);
  program.set("u_shares", 2, pass.round->shares);
  program.set("u_masks", 3, pass.round->masks);
  program.set("u_lights_of", 4, of_shares_);
  program.set("u_first_lights", first ? 1 : 0);
  irradiance_[0].set_in(program, 5);
  irradiance_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(irradiance_[0], irradiance_[1]);
}

void Interleaving::filter(const GBuffer& whole, const View& view) {
  const gl::Texture& all_lights = rounds_.back().shares;
  find_tiles_.set("u_plane_distance", plane_distance_);
  find_tiles_.set("u_points", 0, whole.points);
  tile_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);

  join_tiles_.set("u_plane_distance", plane_distance_);
  join_tiles_.set("u_tiles", 0, tiles_);
  join_tiles_.set("u_shares", 1, all_lights);
  join_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);

  add_rows_.set("u_joins", 0, joins_);
  add_rows_.set("u_shares", 1, all_lights);
  rows_.framebuffer.bind();
  gl::draw_full_screen(no_vertices_);

  std::vector<Pass> passes;
  for (const Round& round : rounds_) {
    for (int i = 0; i < kLightFormulas; ++i) {
      append_passes(round, static_cast<LightFormula>(i), passes);
    }
  }

  // Smooth tiles, into what the last of the passes over the others will draw into.
  irradiance_[passes.size() % 2].framebuffer.bind();
  apply({.stencil = StencilUse::kMark, .reference = 1}, view);
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(view), 0);
  add_columns_.set("u_joins", 0, joins_);
  rows_.set_in(add_columns_, 1);
  gl::draw_full_screen(no_vertices_);

  apply({.stencil = StencilUse::kMatch, .reference = 0}, view);
  for (const Pass& pass : passes) add(whole, pass, &pass == &passes.front());
  reset_draw_state();
  gl::check("filtering");
}

void Interleaving::set_irradiance(const gl::Program& program, int unit) const {
  irradiance_[0].set_in(program, unit);
}

}  // namespace lantern
