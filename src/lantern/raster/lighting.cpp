// SPDX-License-Identifier: MIT
#include "lantern/raster/lighting.h"

#include <algorithm>
#include <array>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;

}  // namespace

Lighting::Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                   const gl::ShaderFiles& files, const LightingOptions& options)
    : surfaces_(surfaces),
      shadows_(shadows),
      times_(times),
      g_buffer_(options.width, options.height),
      mask_(gl::Format::kRgba8, options.width, options.height),
      mask_framebuffer_({&mask_}, &g_buffer_.depth),
      light_block_(std::span<const LightRecord>()),
      shading_(files, {.width = options.width,
                       .height = options.height,
                       .lights_binding = kLightsBinding,
                       .tells_lit = options.tells_lit}) {
  for (ShadowMaps* maps : shadows.maps) {
    map_masks_.emplace_back(*maps, files, options.width, options.height);
  }
}

void Lighting::draw(const View& view, std::span<const LightGroup> groups,
                    const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, g_buffer_);
  times_.end();
  light(view, g_buffer_, groups, group_done);
}

void Lighting::light(const View& view, const GBuffer& whole, std::span<const LightGroup> groups,
                     const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  for (MapMasks& masks : map_masks_) masks.look_at(g_buffer_);
  times_.end();
  shading_.clear();
  if (!shadows_.volumes) {
    const float all_seen[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    mask_framebuffer_.bind();
    glClearBufferfv(GL_COLOR, 0, all_seen);
  }
  for (const LightGroup& group : groups) {
    if (shadows_.volumes) shadows_.volumes->draw(group.points, view, mask_framebuffer_, times_);
    last_mask_ = &mask_;
    for (MapMasks& masks : map_masks_) {
      last_mask_ = &masks.draw(group, g_buffer_, *last_mask_, times_);
    }
    add(group, whole, view);
    if (!group_done()) break;
  }
}

/// What the lights of the mask's bits give.
void Lighting::add(const LightGroup& group, const GBuffer& whole, const View& view) {
  std::array<LightRecord, kLightsInGroup> records;
  std::copy(group.records.begin(), group.records.end(), records.begin());
  light_block_.write(std::span<const LightRecord>(records));
  light_block_.bind_as_uniforms(kLightsBinding);
  times_.begin(Stage::kShading);
  shading_.add(group, whole, *last_mask_, view);
  times_.end();
}

}  // namespace lantern
