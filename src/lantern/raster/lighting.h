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
#include <list>
#include <span>
#include <vector>

namespace lantern {

/// Who says which lights are seen; where both are there both must say so.
struct Shadows {
  StencilShadows* volumes = nullptr;
  std::vector<ShadowMaps*> maps = {};
};

struct LightingOptions {
  int width, height;       // of views
  bool tells_lit = false;  // see MaskedShading::copy_to()
};

class Lighting {
 public:
  /// Keeps references to `surfaces`, `times` and what `shadows` points to.
  Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
           const gl::ShaderFiles& files, const LightingOptions& options);

  /// Calls `group_done` after each group; once it returns false the rest is left out.
  void draw(const View& view, std::span<const LightGroup> groups,
            const std::function<bool()>& group_done);
  /// As draw(), of pixels view.first, view.first + view.step, ... of `whole`. Of g_buffer() there
  /// must be the depth and, if takes_g_buffer(), all.
  void light(const View& view, const GBuffer& whole, std::span<const LightGroup> groups,
             const std::function<bool()>& group_done);
  bool takes_g_buffer() const { return !map_masks_.empty(); }

  const GBuffer& g_buffer() const { return g_buffer_; }
  /// Which lights of the group that was done last are seen, RGBA8.
  const gl::Texture& mask() const { return *last_mask_; }
  /// What there is by now.
  const MaskedShading& shading() const { return shading_; }

 private:
  void add(const LightGroup& group, const GBuffer& whole, const View& view);

  const Surfaces& surfaces_;
  Shadows shadows_;
  StageTimes& times_;
  GBuffer g_buffer_;
  gl::Texture mask_;
  gl::Framebuffer mask_framebuffer_;
  gl::Buffer light_block_;
  std::list<MapMasks> map_masks_;
  const gl::Texture* last_mask_ = &mask_;
  MaskedShading shading_;
};

}  // namespace lantern
