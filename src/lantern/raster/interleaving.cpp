// SPDX-License-Identifier: MIT
#include "lantern/raster/interleaving.h"

#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"
#include "lantern/raster/light_shares.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;
constexpr int kTilesOfQuad = 4;
/// What the stencil tells of quads of pixels.
constexpr int kRoughQuads = 0, kRoughQuadsAmidPlane = 1, kSmoothQuads = 2;

int round_up(int n, int step) { return (n + step - 1) / step * step; }

/// Pixels of a row that a fragment makes.
int columns_of(int tile) { return std::min(tile, 4); }

gl::Program program_of(const gl::ShaderFiles& files, const char* fragment, int tile,
                       const std::vector<gl::Definition>& more = {}) {
  std::vector<gl::Definition> definitions = Interleaving::definitions(tile);
  definitions.insert(definitions.end(), more.begin(), more.end());
  return gl::Program(files, "shaders/full_screen.vert.glsl", fragment, definitions);
}

std::vector<gl::Program> programs_of_lights(const gl::ShaderFiles& files, const char* fragment,
                                            int tile, bool amid_plane = false) {
  std::vector<gl::Program> programs;
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    programs.push_back(program_of(files, fragment, tile,
                                  {{"KIND", std::to_string(formula)},
                                   {"LIGHTS", std::to_string(kLightsInRound)},
                                   {"AMID_PLANE", amid_plane ? "1" : "0"}}));
    programs.back().set_block("Lights", kLightsBinding);
  }
  return programs;
}

bool asks_more_than_depth(const Shadows& shadows) {
  return !shadows.maps.empty() || (shadows.volumes && shadows.volumes->needs_depth_of_view());
}

}  // namespace

std::vector<gl::Definition> Interleaving::definitions(int tile) {
  return {{"TILE", std::to_string(tile)}};
}

Interleaving::SharePictures::SharePictures(const glm::ivec2& size, bool asks_all) {
  if (asks_all) {
    all.emplace(size.x, size.y);
    // No surfaces between the pictures.
    all->framebuffer.bind();
    const GLuint nothing[4] = {};
    const float black[4] = {};
    for (int i = 0; i < 2; ++i) glClearBufferuiv(GL_COLOR, i, nothing);
    glClearBufferfv(GL_COLOR, 2, black);
    return;
  }
  depth_alone.emplace(gl::Format::kDepth32fStencil8, size.x, size.y);
  depth_framebuffer.emplace(std::initializer_list<const gl::Texture*>(), &*depth_alone);
}

Interleaving::Quads::Quads(int width, int height, const gl::Texture& stencil)
    : red(gl::Format::kRgba32f, width, height),
      green(gl::Format::kRgba32f, width, height),
      blue(gl::Format::kRgba32f, width, height),
      framebuffer({&red, &green, &blue}, &stencil) {}

void Interleaving::Quads::set_in(const gl::Program& program, int unit) const {
  program.set("u_red", unit, red);
  program.set("u_green", unit + 1, green);
  program.set("u_blue", unit + 2, blue);
}

Interleaving::TileQuads::TileQuads(int width, int height)
    : red(gl::Format::kRgba32f, width, height),
      green(gl::Format::kRgba32f, width, height),
      blue(gl::Format::kRgba32f, width, height),
      changes(gl::Format::kRgba32f, width, height),
      framebuffer({&red, &green, &blue, &changes}) {}

void Interleaving::TileQuads::set_in(const gl::Program& program, int unit) const {
  program.set("u_red", unit, red);
  program.set("u_green", unit + 1, green);
  program.set("u_blue", unit + 2, blue);
  program.set("u_changes", unit + 3, changes);
}

Interleaving::Round::Round(const gl::Texture& depth, int shares)
    : masks(depth),
      lights_of(gl::Format::kRg32ui, shares, 1),
      lights(std::span<const LightRecord>()) {}

// A tile sees about a hundredth of the scene; further off its plane is another surface. Shares'
// pictures begin where quads of tiles do.
Interleaving::Interleaving(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                           const gl::ShaderFiles& files, const ViewOptions& options)
    : surfaces_(surfaces),
      times_(times),
      view_options_(options),
      tile_(options.step),
      tiles_(options.columns(), options.rows()),
      share_size_(round_up(tiles_.x, kTilesOfQuad), round_up(tiles_.y, kTilesOfQuad)),
      plane_distance_(1e-2f * options.radius),
      whole_(options.width, options.height),
      shares_(tile_ * share_size_, asks_more_than_depth(shadows)),
      masks_(shadows, times, files, shares_.depth().width(), shares_.depth().height()),
      split_(program_of(files, "shaders/interleaved_split.frag.glsl", tile_,
                        {{"POINTS", shares_.all ? "1" : "0"}})),
      find_tiles_(program_of(files, "shaders/interleaved_tiles.frag.glsl", tile_)),
      join_tiles_(program_of(files, "shaders/interleaved_joins.frag.glsl", tile_)),
      find_middles_(program_of(files, "shaders/interleaved_middles.frag.glsl", tile_)),
      fill_smooth_(program_of(files, "shaders/interleaved_smooth.frag.glsl", tile_)),
      cover_amid_(program_of(files, "shaders/interleaved_amid.frag.glsl", tile_)),
      add_shares_(programs_of_lights(files, "shaders/interleaved_shares.frag.glsl", tile_)),
      add_lights_(programs_of_lights(files, "shaders/interleaved_lights.frag.glsl", tile_)),
      add_lights_amid_(
          programs_of_lights(files, "shaders/interleaved_lights.frag.glsl", tile_, true)),
      planes_(gl::Format::kRgba32ui, tiles_.x, tiles_.y),
      joins_(gl::Format::kR32ui, tiles_.x, tiles_.y),
      middles_(gl::Format::kRgba32ui, tiles_.x, tiles_.y),
      stencil_(gl::Format::kDepth32fStencil8,
               round_up(options.width, columns_of(tile_)) / columns_of(tile_) * tile_, tiles_.y),
      planes_framebuffer_({&planes_}),
      joins_framebuffer_({&joins_}),
      middles_framebuffer_({&middles_}),
      tile_irradiance_{TileQuads(share_size_.x / kTilesOfQuad, tiles_.y),
                       TileQuads(share_size_.x / kTilesOfQuad, tiles_.y)},
      irradiance_{Quads(stencil_.width(), stencil_.height(), stencil_),
                  Quads(stencil_.width(), stencil_.height(), stencil_)} {}

void Interleaving::split(const View& view) const {
  shares_.framebuffer().bind();
  apply({.depth = DepthUse::kReplace}, view);
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(view), 0);
  split_.set("u_depth", 0, whole_.depth);
  split_.set("u_share_size", share_size_);
  if (shares_.all) {
    split_.set("u_points", 1, whole_.points);
    split_.set("u_reflectances", 2, whole_.reflectances);
    split_.set("u_emissions", 3, whole_.emissions);
  }
  gl::draw_full_screen(no_vertices_);
  reset_draw_state();
  gl::check("splitting");
}

void Interleaving::draw_surfaces(const View& view, std::span<const View> of_shares) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, whole_);
  if (masks_.needs_depth_of_views()) {
    for (const View& of_share : of_shares) surfaces_.draw(of_share, *shares_.all);
  } else {
    split(view);
  }
  if (masks_.asks_points()) masks_.look_at(*shares_.all);
  times_.end();
}

void Interleaving::look(Round& round, std::span<const View> of_shares,
                        std::span<const LightGroup> groups) {
  std::vector<GroupInView> in_view;
  std::vector<LightRecord> lights;
  std::vector<std::uint32_t> lights_of(2 * of_shares.size());
  for (const LightGroup& group : groups) {
    in_view.push_back({of_shares[group.share], group});
    lights_of[2 * group.share] = static_cast<std::uint32_t>(lights.size());
    lights_of[2 * group.share + 1] = static_cast<std::uint32_t>(group.records.size());
    lights.insert(lights.end(), group.records.begin(), group.records.end());
  }
  lights.resize(kLightsInRound);
  round.formula = groups.front().formula;
  round.lights.write(std::span<const LightRecord>(lights));
  round.lights_of.write(std::span<const std::uint32_t>(lights_of));
  const gl::Texture& seen = masks_.draw(in_view, round.masks);
  if (&seen == &round.masks.mask) return;
  const gl::Framebuffer masks({&seen});
  masks.bind();
  round.masks.mask.bind(0);
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, seen.width(), seen.height());
  gl::check("keeping masks");
}

void Interleaving::set_in(const gl::Program& program, const Round& round, bool first) const {
  round.lights.bind_as_uniforms(kLightsBinding);
  program.set("u_masks", 0, round.masks.mask);
  program.set("u_lights_of", 1, round.lights_of);
  program.set("u_first_round", first ? 1 : 0);
}

void Interleaving::add_to_tiles(const Round& round, bool first) {
  const gl::Program& program = add_shares_[static_cast<std::size_t>(round.formula)];
  set_in(program, round, first);
  program.set("u_plane_distance", plane_distance_);
  program.set("u_tiles", 2, planes_);
  program.set("u_joins", 3, joins_);
  tile_irradiance_[0].set_in(program, 4);
  tile_irradiance_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(tile_irradiance_[0], tile_irradiance_[1]);
}

void Interleaving::add_to_pixels(const Round& round, bool first, const View& view) {
  irradiance_[1].framebuffer.bind();
  for (const int part : {kRoughQuads, kRoughQuadsAmidPlane}) {
    const auto& programs = part == kRoughQuads ? add_lights_ : add_lights_amid_;
    const gl::Program& program = programs[static_cast<std::size_t>(round.formula)];
    set_in(program, round, first);
    if (part == kRoughQuads) program.set("u_plane_distance", plane_distance_);
    program.set("u_points", 2, whole_.points);
    program.set("u_reflectances", 3, whole_.reflectances);
    irradiance_[0].set_in(program, 4);
    apply({.stencil = StencilUse::kMatch, .reference = part}, view);
    gl::draw_full_screen(no_vertices_);
  }
  std::swap(irradiance_[0], irradiance_[1]);
}

/// The irradiance of all pixels, by what is known of tiles and by the first of the rounds.
void Interleaving::fill(const View& view, std::size_t rounds) {
  if (rounds == 0) {
    irradiance_[0].framebuffer.bind();
    const float none[4] = {};
    for (int colour = 0; colour < 3; ++colour) glClearBufferfv(GL_COLOR, colour, none);
    return;
  }
  find_middles_.set("u_tiles", 0, planes_);
  find_middles_.set("u_joins", 1, joins_);
  tile_irradiance_[0].set_in(find_middles_, 2);
  middles_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);

  // Into what the last of the rounds will draw into.
  irradiance_[rounds % 2].framebuffer.bind();
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(view), kRoughQuads);
  apply({.stencil = StencilUse::kMark, .reference = kRoughQuadsAmidPlane, .colour = false}, view);
  cover_amid_.set("u_middles", 0, middles_);
  gl::draw_full_screen(no_vertices_);
  apply({.stencil = StencilUse::kMark, .reference = kSmoothQuads}, view);
  fill_smooth_.set("u_middles", 0, middles_);
  gl::draw_full_screen(no_vertices_);

  for (std::size_t i = 0; i < rounds; ++i) add_to_pixels(rounds_[i], i == 0, view);
  reset_draw_state();
  gl::check("filling pixels");
}

void Interleaving::draw(const Camera& camera, const Vec2& offset,
                        std::span<const LightGroup> groups,
                        const std::function<bool()>& group_done) {
  ViewOptions options = view_options_;
  options.offset = offset;
  std::vector<View> of_shares;
  for (int share = 0; share < tile_ * tile_; ++share) {
    options.first = {share % tile_, share / tile_};
    options.origin = options.first * share_size_;
    of_shares.push_back(make_view(camera, options));
  }
  options.step = 1;
  options.first = options.origin = glm::ivec2(0);
  const View view = make_view(camera, options);

  draw_surfaces(view, of_shares);
  times_.begin(Stage::kFilter);
  find_tiles_.set("u_plane_distance", plane_distance_);
  find_tiles_.set("u_points", 0, whole_.points);
  planes_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  join_tiles_.set("u_plane_distance", plane_distance_);
  join_tiles_.set("u_tiles", 0, planes_);
  joins_framebuffer_.bind();
  gl::draw_full_screen(no_vertices_);
  times_.end();

  std::size_t rounds = 0;
  bool go_on = true;
  while (go_on && !groups.empty()) {
    const auto end = std::find_if(groups.begin(), groups.end(), [&](const LightGroup& group) {
      return group.round != groups.front().round;
    });
    const auto of_round = groups.first(static_cast<std::size_t>(end - groups.begin()));
    if (rounds == rounds_.size()) {
      rounds_.emplace_back(shares_.depth(), tile_ * tile_);
    }
    look(rounds_[rounds], of_shares, of_round);
    times_.begin(Stage::kShading);
    add_to_tiles(rounds_[rounds], rounds == 0);
    times_.end();
    ++rounds;
    for (std::size_t i = 0; i < of_round.size(); ++i) go_on = group_done() && go_on;
    groups = groups.subspan(of_round.size());
  }
  while (rounds_.size() > std::max<std::size_t>(rounds, 1)) rounds_.pop_back();
  times_.begin(Stage::kFilter);
  fill(view, rounds);
  times_.end();
}

void Interleaving::set_irradiance(const gl::Program& program, int unit) const {
  irradiance_[0].set_in(program, unit);
}

}  // namespace lantern
