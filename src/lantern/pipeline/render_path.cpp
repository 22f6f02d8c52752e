// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_path.h"

#include "lantern/path/path_tracer.h"
#include "lantern/path/variance.h"
#include "lantern/pipeline/passes.h"

namespace lantern {

Rendered render_path(const RenderJob& job) {
  const RenderOptions& options = job.options;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  const LightChoice lights(job.scene, job.world);
  require_light(lights.has_light());
  const PathInput input{job.scene, job.world, job.tracer, lights, job.camera};
  PathOptions trace_with;
  trace_with.width = options.width;
  trace_with.height = options.height;
  trace_with.samples = options.samples;
  trace_with.seed = options.path.seed;
  trace_with.squares = options.path.variance;
  statistics.seconds_prepare = job.watch.seconds();

  std::optional<VarianceEstimate> variance;
  if (options.path.variance) variance.emplace(options.width, options.height, options.samples);
  PathCounts rays;
  const Stopwatch watch;
  Passes passes(job);
  while (passes.next()) {
    trace_with.pass = passes.number();
    const PathPass pass = trace_paths(input, trace_with, rays, job.stop,
                                      [&](std::size_t pixels) { passes.pixels_done(pixels); });
    if (!passes.add(pass.radiance)) break;
    if (variance) variance->add(pass);
  }
  statistics.seconds_gather = watch.seconds();
  statistics.passes = passes.count();
  statistics.paths = rays.camera_rays;
  statistics.rays.camera_rays = rays.camera_rays;
  statistics.rays.shadow_rays = rays.shadow_rays;
  statistics.rays.bounce_rays = rays.bounce_rays;
  result.image = passes.mean();
  if (variance) result.variance = variance->of_mean();
  return result;
}

}  // namespace lantern
