// SPDX-License-Identifier: MIT
#include "lantern/raster/lighting.h"

#include <algorithm>
#include <array>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;

}  // namespace

Lighting::Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                   const gl::ShaderFiles& files, int width, int height)
    : surfaces_(surfaces),
      times_(times),
      g_buffer_(width, height),
      masks_(shadows, times, files, width, height),
      mask_(g_buffer_.depth),
      light_block_(std::span<const LightRecord>()),
      shading_(files, width, height, kLightsBinding) {}

void Lighting::draw(const View& view, std::span<const LightGroup> groups,
                    const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, g_buffer_);
  masks_.look_at(g_buffer_);
  times_.end();
  shading_.clear();
  for (const LightGroup& group : groups) {
    const GroupInView in_view{view, group};
    add(group, masks_.draw(std::span(&in_view, 1), mask_));
    if (!group_done()) break;
  }
}

/// What the lights of the mask's bits give.
void Lighting::add(const LightGroup& group, const gl::Texture& mask) {
  std::array<LightRecord, kLightsInGroup> records;
  std::copy(group.records.begin(), group.records.end(), records.begin());
  light_block_.write(std::span<const LightRecord>(records));
  light_block_.bind_as_uniforms(kLightsBinding);
  times_.begin(Stage::kShading);
  shading_.add(group, g_buffer_, mask);
  times_.end();
}

}  // namespace lantern
