// SPDX-License-Identifier: MIT
// Unbiased path tracing of Lambertian scenes, the judge of all other methods: next-event estimation
// and cosine-distributed rays, weighted against each other; roulette after the first bounces.
// [Kajiya 1986, The Rendering Equation; weights: Veach & Guibas 1995, balance heuristic]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/image/image.h"
#include "lantern/path/light_choice.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace lantern {

struct PathOptions {
  int width = 512;
  int height = 512;
  int samples = 64;      // per pixel and pass
  std::size_t pass = 0;  // each has random numbers of its own
  std::uint64_t seed = 0;
  bool squares = false;  // the samples' squares as well
};

struct PathCounts {
  std::uint64_t camera_rays = 0;
  std::uint64_t bounce_rays = 0;
  std::uint64_t shadow_rays = 0;
};

/// What the scene is, ready to be traced; the parts must outlive the call.
struct PathInput {
  const Scene& scene;
  const World& world;
  const Tracer& tracer;
  const LightChoice& lights;
  const Camera& camera;
};

/// Means over the samples of a pass, pixel by pixel.
struct PathPass {
  Image radiance;
  Image squared_radiance;  // empty unless asked for
};

/// The picture of one pass. Ends early, with black tiles where not all samples were taken, once
/// `stop` is set; calls `tile_done` (from any thread) with the number of pixels of each tile.
PathPass trace_paths(const PathInput& input, const PathOptions& options, PathCounts& counts,
                     const StopFlag& stop, const std::function<void(std::size_t)>& tile_done = {});

}  // namespace lantern
