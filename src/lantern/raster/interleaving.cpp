// SPDX-License-Identifier: MIT
#include "lantern/raster/interleaving.h"

#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"

#include <algorithm>

namespace lantern {
namespace {

int round_up(int n, int step) { return (n + step - 1) / step * step; }

/// What is further off a plane is another surface: a slab and the wall below it.
float plane_distance(const ViewOptions& options) { return 1e-4f * options.radius; }

/// Where a shadow ends each share knows to one of its pixels.
constexpr float kSlack = 0.25f;

bool asks_more_than_depth(const Shadows& shadows) {
  return !shadows.maps.empty() || (shadows.volumes && shadows.volumes->needs_depth_of_view());
}

}  // namespace

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

// Shares' pictures begin where quads of tiles do.
Interleaving::Interleaving(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                           const gl::ShaderFiles& files, const ViewOptions& options)
    : surfaces_(surfaces),
      times_(times),
      view_options_(options),
      tile_(options.step),
      share_size_(round_up(options.columns(), TileIrradiance::kTilesOfQuad), options.rows()),
      whole_(options.width, options.height),
      shares_(tile_ * share_size_, asks_more_than_depth(shadows)),
      masks_(shadows, times, files, shares_.depth().width(), shares_.depth().height()),
      split_(tile_program(files, "shaders/interleaved_split.frag.glsl", tile_,
                          {{"POINTS", shares_.all ? "1" : "0"}})),
      tile_irradiance_(files, tile_, options.columns(), options.rows(), plane_distance(options)),
      irradiance_(files, tile_, options.width, options.height, plane_distance(options)) {}

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

void Interleaving::look(LightRound& round, std::span<const View> of_shares,
                        std::span<const LightGroup> groups) {
  round.hold(groups);
  std::vector<GroupInView> in_view;
  for (const LightGroup& group : groups) {
    in_view.push_back({of_shares[group.share], group, kSlack});
  }
  const gl::Texture& seen = masks_.draw(in_view, round.masks);
  if (&seen == &round.masks.mask) return;
  const gl::Framebuffer masks({&seen});
  masks.bind();
  round.masks.mask.bind(0);
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, seen.width(), seen.height());
  gl::check("keeping masks");
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
  tile_irradiance_.look_at(whole_);
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
    tile_irradiance_.add(rounds_[rounds], rounds == 0);
    times_.end();
    ++rounds;
    for (std::size_t i = 0; i < of_round.size(); ++i) go_on = group_done() && go_on;
    groups = groups.subspan(of_round.size());
  }
  while (rounds_.size() > rounds) rounds_.pop_back();
  times_.begin(Stage::kFilter);
  irradiance_.fill(tile_irradiance_.find_middles(), whole_, view, rounds_);
  times_.end();
}

}  // namespace lantern
