// SPDX-License-Identifier: MIT
// Irradiance of elements -> a picture: interpolated between the vertices of each smooth surface
// [Goral et al. 1984, section 5], times the reflectance at each point of the surface in full
// resolution, plus the exact emission. Radiance in W/(m² sr).
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/image/image.h"
#include "lantern/radiosity/patches.h"
#include "lantern/scene/scene.h"
#include "lantern/trace/tracer.h"

#include <functional>
#include <memory>
#include <span>

namespace lantern {

struct DisplayOptions {
  int width = 512;
  int height = 512;
  int samples = 4;  // per pixel, well spread
};

/// Ready to draw any number of solutions on the same patches.
class Display {
 public:
  /// Keeps references to `scene` and `patches`.
  Display(const Scene& scene, const World& world, const Patches& patches);

  /// `irradiance` in W/m², one for each element. Ends early, with black where nothing was done,
  /// once `stop` is set; calls `rows_done` (from any thread) with the number of finished pixels.
  Image draw(const Camera& camera, std::span<const glm::dvec3> irradiance,
             const DisplayOptions& options, const StopFlag& stop,
             const std::function<void(std::size_t)>& rows_done = {}) const;

 private:
  const Scene& scene_;
  const Patches& patches_;
  World world_;  // of the patches
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace lantern
