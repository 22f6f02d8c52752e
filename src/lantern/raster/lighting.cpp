// SPDX-License-Identifier: MIT
#include "lantern/raster/lighting.h"

namespace lantern {

Lighting::Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                   const gl::ShaderFiles& files, int width, int height)
    : surfaces_(surfaces),
      times_(times),
      g_buffer_(width, height),
      mask_(g_buffer_.depth),
      shading_(files, width, height, shadows.volumes || shadows.maps.size() != 1,
               !shadows.maps.empty()) {
  Shadows others = shadows;
  if (!shadows.maps.empty()) {
    last_maps_.emplace(*shadows.maps.back(), files, width, height);
    others.maps.pop_back();
  }
  const bool only_maps = last_maps_ && !others.volumes && others.maps.empty();
  if (!only_maps) masks_.emplace(others, times, files, width, height);
}

void Lighting::draw(const View& view, std::span<const LightGroup> groups,
                    const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, g_buffer_);
  if (masks_) masks_->look_at(g_buffer_);
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
  if (masks_) seen.mask = &masks_->draw(std::span(&in_view, 1), mask_);
  if (last_maps_) {
    last_maps_->ask(group, view, times_);
    seen.maps = &*last_maps_;
  }
  times_.begin(last_maps_ ? Stage::kMaps : Stage::kShading);
  shading_.add(group, g_buffer_, seen, is_first);
  times_.end();
}

}  // namespace lantern
