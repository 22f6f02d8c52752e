// SPDX-License-Identifier: MIT
// What a view sees and how much light gets there: surfaces into a G-buffer, which lights each pixel
// sees as bits of a mask, 32 lights shaded at a time.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/map_masks.h"
#include "lantern/raster/masked_shading.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <functional>
#include <optional>
#include <span>

namespace lantern {

/// A picture that one draws into.
struct Target {
  gl::Texture texture;
  gl::Framebuffer framebuffer;

  Target(gl::Format format, int width, int height)
      : texture(format, width, height), framebuffer({&texture}) {}
};

/// Who says which lights are seen; where both are there both must say so.
struct Shadows {
  StencilShadows* volumes = nullptr;
  ShadowMaps* maps = nullptr;
};

class Lighting {
 public:
  /// Keeps references to `surfaces`, `times` and what `shadows` points to. Views must have this
  /// size.
  Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
           const gl::ShaderFiles& files, int width, int height);

  /// Calls `group_done` after each group; once it returns false the rest is left out.
  void draw(const View& view, std::span<const LightGroup> groups,
            const std::function<bool()>& group_done);

  const GBuffer& g_buffer() const { return g_buffer_; }
  /// In W/m², RGBA32F.
  const Target& irradiance() const { return irradiance_; }

 private:
  void add(const LightGroup& group, const gl::Texture& mask);

  const Surfaces& surfaces_;
  Shadows shadows_;
  StageTimes& times_;
  GBuffer g_buffer_;
  gl::Texture mask_;
  gl::Framebuffer mask_framebuffer_;
  gl::Buffer light_block_;
  std::optional<MapMasks> map_masks_;
  MaskedShading shading_;
  Target irradiance_;
};

}  // namespace lantern
