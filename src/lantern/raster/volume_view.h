// SPDX-License-Identifier: MIT
// The shadow volumes of one light, translucent over a picture, as textbooks draw them: orange where
// the eye looks at their outside, blue where at their inside.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/image/image.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <vector>

namespace lantern {

class VolumeView {
 public:
  /// Keeps a reference to `g_buffer`, of what volumes stand before.
  explicit VolumeView(const GBuffer& g_buffer);

  /// One more sample of all pixels; the G-buffer was drawn with this view.
  void add(StencilShadows& shadows, const LightPoint& light, const View& view);

  /// Over the picture, about as bright as what is lit there.
  void blend_over(Image& image) const;

 private:
  gl::Texture sides_;
  gl::Framebuffer framebuffer_;
  std::vector<Vec4> sum_;  // of the samples: colour times cover, cover
  int samples_ = 0;
};

}  // namespace lantern
