// SPDX-License-Identifier: MIT
// Where the geometry term cos_x cos_y / d² of a surface light is cut. [Kollig & Keller 2004]
#pragma once

#include "lantern/lights/emitters.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <cstdint>
#include <vector>

namespace lantern {

/// Reflected light has one bound, relative to the scene. Light straight from an emitter has a
/// higher one where its lights lie densely: at a geometry term above π times their number per area
/// a ray from the point would find the emitter more surely than they do (the balance heuristic's
/// crossing [Veach & Guibas 1995]); below it they do better, however small and bright it is.
class TermBound {
 public:
  /// `relative` in 1/(bounding radius)²; 0: no bound at all. Keeps references to `scene` and
  /// `world`.
  TermBound(const Scene& scene, const World& world, const Emitters& emitters,
            const VirtualLights& lights, float relative);

  bool none() const { return !(reflected_ < kInfinity); }
  float reflected() const { return reflected_; }
  float emitted(std::uint32_t triangle) const;
  /// One for each light: that of its emitter where a path starts, else that of reflected light.
  std::vector<float> of_lights(const VirtualLights& lights, const Tracer& tracer) const;

 private:
  const Scene& scene_;
  const World& world_;
  float reflected_ = kInfinity;
  float emitted_per_radiance_ = 0.0f;
};

}  // namespace lantern
