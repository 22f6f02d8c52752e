// SPDX-License-Identifier: MIT
#include "lantern/raster/light_masks.h"

namespace lantern {

LightMasks::LightMasks(const Shadows& shadows, StageTimes& times, const gl::ShaderFiles& files,
                       int width, int height)
    : shadows_(shadows), times_(times) {
  for (ShadowMaps* maps : shadows.maps) map_masks_.emplace_back(*maps, files, width, height);
}

void LightMasks::look_at(const GBuffer& picture) {
  picture_ = &picture;
  for (MapMasks& masks : map_masks_) masks.look_at(picture);
}

const gl::Texture& LightMasks::draw(std::span<const GroupInView> views, const MaskPicture& to) {
  if (shadows_.volumes) {
    std::vector<LightsInView> lights;
    for (const GroupInView& of_view : views) {
      lights.push_back({of_view.view, of_view.group.points, of_view.group.fronts, of_view.slack});
    }
    shadows_.volumes->draw(lights, to.framebuffer, times_);
  } else {
    const float all_seen[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    to.framebuffer.bind();
    glClearBufferfv(GL_COLOR, 0, all_seen);
  }
  const gl::Texture* mask = &to.mask;
  for (MapMasks& masks : map_masks_) {
    const gl::Texture* next = mask;
    for (const GroupInView& of_view : views) {
      next = &masks.draw(of_view.group, of_view.view, *picture_, *mask, times_);
    }
    mask = next;
  }
  return *mask;
}

}  // namespace lantern
