// SPDX-License-Identifier: MIT
#include "lantern/raster/lighting.h"

namespace lantern {
namespace {

Witnesses witnesses_of(const Shadows& shadows) {
  if (shadows.maps.empty()) return Witnesses::kMask;
  return shadows.volumes || shadows.maps.size() > 1 ? Witnesses::kBoth : Witnesses::kMaps;
}

}  // namespace

Lighting::Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                   const gl::ShaderFiles& files, int width, int height)
    : surfaces_(surfaces),
      times_(times),
      g_buffer_(width, height),
      shading_(files, width, height, witnesses_of(shadows)) {
  Shadows others = shadows;
  if (!shadows.maps.empty()) {
    last_maps_.emplace(*shadows.maps.back(), files, width, height);
    others.maps.pop_back();
  }
  if (witnesses_of(shadows) == Witnesses::kMaps) return;
  masks_.emplace(
      Masks{LightMasks(others, times, files, width, height), MaskPicture(g_buffer_.depth)});
}

void Lighting::draw(const View& view, std::span<const LightGroup> groups,
                    const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, g_buffer_);
  if (masks_) masks_->of_lights.look_at(g_buffer_);
  if (last_maps_) last_maps_->look_at(g_buffer_);
  times_.end();
  if (groups.empty()) shading_.clear();
  for (const LightGroup& group : groups) {
    add(view, group, &group == &groups.front());
    if (!group_done()) break;
  }
}

void Lighting::add(const View& view, const LightGroup& group, bool is_first) {
  SeenBy seen;
  const GroupInView in_view{view, group};
  if (masks_) seen.mask = &masks_->of_lights.draw(std::span(&in_view, 1), masks_->picture);
  if (last_maps_) {
    last_maps_->ask(group, view, times_);
    seen.maps = &*last_maps_;
  }
  // Where maps are asked is where light is added.
  times_.begin(last_maps_ ? Stage::kMaps : Stage::kShading);
  shading_.add(group, g_buffer_, seen, is_first);
  times_.end();
}

}  // namespace lantern
