// SPDX-License-Identifier: MIT
// What render() hands to every method: a scene ready to be traced, the camera, what is asked for
// and who wants to know how far it is.
#pragma once

#include "lantern/pipeline/render.h"
#include "lantern/pipeline/stopwatch.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

namespace lantern {

struct RenderJob {
  const Scene& scene;
  const World& world;
  const Tracer& tracer;
  const Camera& camera;
  const RenderOptions& options;
  const StopFlag& stop;
  const ProgressReport& report;  // may be empty
  const Stopwatch& watch;        // since render() was called
  double elapsed = 0.0;          // seconds that had passed by then
};

/// Throws Error if the scene has no triangles.
World make_traceable_world(const Scene& scene);

/// Throws Error, naming what would help, unless the scene has a light.
void require_light(bool has_light);

}  // namespace lantern
