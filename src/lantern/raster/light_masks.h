// SPDX-License-Identifier: MIT
// Which lights pixels see, as the bits of a mask, by all that casts shadows: volumes, maps, or
// both.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/map_masks.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <list>
#include <span>
#include <vector>

namespace lantern {

/// Who says which lights are seen; where both are there both must say so.
struct Shadows {
  StencilShadows* volumes = nullptr;
  std::vector<ShadowMaps*> maps = {};
};

/// A group of lights and from where it is looked at.
struct GroupInView {
  const View& view;
  const LightGroup& group;
  float slack = 0.0f;  // in its pixels: how far silhouettes may be off
};

/// Bit i (RGBA8, the lowest byte in red): whether light i of a group is seen.
struct MaskPicture {
  gl::Texture mask;
  gl::Framebuffer framebuffer;
  /// Of a picture with this depth and stencil, which must outlive it.
  explicit MaskPicture(const gl::Texture& depth)
      : mask(gl::Format::kRgba8, depth.width(), depth.height()), framebuffer({&mask}, &depth) {}
};

class LightMasks {
 public:
  /// Of pictures of this size. Keeps references to what `shadows` points to.
  LightMasks(const Shadows& shadows, StageTimes& times, const gl::ShaderFiles& files, int width,
             int height);

  /// Whether look_at() must be called for each picture, or its depth suffices.
  bool asks_points() const { return !map_masks_.empty(); }
  /// Whether that depth must be of the very views, to its last bit.
  bool needs_depth_of_views() const {
    return shadows_.volumes && shadows_.volumes->needs_depth_of_view();
  }
  /// Keeps a reference until the next.
  void look_at(const GBuffer& picture);

  /// Each view has its own part of the picture, in which it is asked for one group. The result is
  /// drawn into `to` or, where maps have the last word, is theirs until the next.
  const gl::Texture& draw(std::span<const GroupInView> views, const MaskPicture& to);

 private:
  Shadows shadows_;
  StageTimes& times_;
  std::list<MapMasks> map_masks_;
  const GBuffer* picture_ = nullptr;
};

}  // namespace lantern
