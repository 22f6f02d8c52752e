// SPDX-License-Identifier: MIT
#include "lantern/raster/light_masks.h"

namespace lantern {

LightMasks::LightMasks(const Shadows& shadows, StageTimes& times, const gl::ShaderFiles& files,
                       const gl::Texture& depth)
    : shadows_(shadows),
      times_(times),
      mask_(gl::Format::kRgba8, depth.width(), depth.height()),
      framebuffer_({&mask_}, &depth) {
  for (ShadowMaps* maps : shadows.maps) {
    map_masks_.emplace_back(*maps, files, depth.width(), depth.height());
  }
  // Volumes draw all of it anew each time.
  const float all_seen[4] = {1.0f, 1.0f, 1.0f, 1.0f};
  framebuffer_.bind();
  glClearBufferfv(GL_COLOR, 0, all_seen);
}

void LightMasks::look_at(const GBuffer& picture) {
  picture_ = &picture;
  for (MapMasks& masks : map_masks_) masks.look_at(picture);
}

const gl::Texture& LightMasks::draw(std::span<const GroupInView> views) {
  if (shadows_.volumes) {
    std::vector<LightsInView> lights;
    for (const GroupInView& of_view : views) {
      lights.push_back({of_view.view, of_view.group.points});
    }
    shadows_.volumes->draw(lights, framebuffer_, times_);
  }
  const gl::Texture* mask = &mask_;
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
