// SPDX-License-Identifier: MIT
// Directions of a textured sky, chosen by how bright it is there.
#pragma once

#include "lantern/scene/scene.h"

#include <vector>

namespace lantern {

/// Draws directions of a textured sky with a density that follows its luminance.
class SkySampler {
 public:
  /// `scene` must have a sky with a texture; it is kept by reference.
  explicit SkySampler(const Scene& scene);

  struct Draw {
    Vec3 towards;              // unit
    Rgb radiance_over_pdf{0};  // pdf in 1/sr
  };
  /// `u` in [0, 1)².
  Draw draw(Vec2 u) const;

 private:
  const Scene& scene_;
  int width_, height_;
  std::vector<double> rows_, cells_;  // cumulated; `cells_` within each row
};

}  // namespace lantern
