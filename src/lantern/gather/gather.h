// SPDX-License-Identifier: MIT
// (Scene, VirtualLights, Tracer) -> Image on the CPU: every pixel sample against every light.
// [Keller 1997; the bound's compensation: Kollig & Keller 2004, Illumination in the Presence of
// Weak Singularities, section 3]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/gather/kernel.h"
#include "lantern/image/image.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace lantern {

struct GatherOptions {
  int width = 512;
  int height = 512;
  int samples = 1;          // per pixel and pass, every one against all lights
  std::size_t pass = 0;     // places the samples of pass k where no other pass has them
  float bound = 0.0f;       // on the geometry term, in units of 1/(bounding radius)²; 0: none
  bool compensate = false;  // trace what the bound takes
  std::uint64_t seed = 0;
  ShadowRays shadow_rays = ShadowRays::kPackets;
};

struct GatherCounts {
  std::uint64_t camera_rays = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t compensation_rays = 0;
};

/// What the scene is, ready to be gathered from; the parts must outlive the call.
struct GatherInput {
  const Scene& scene;
  const World& world;
  const Tracer& tracer;
  const Emitters& emitters;
  const Camera& camera;
};

/// The picture of one pass. Ends early, with black where nothing was done, once `stop` is set;
/// calls `tile_done` (from any thread) with the number of pixels of each finished tile.
Image gather(const GatherInput& input, const VirtualLights& lights, const GatherOptions& options,
             GatherCounts& counts, const StopFlag& stop,
             const std::function<void(std::size_t)>& tile_done = {});

}  // namespace lantern
