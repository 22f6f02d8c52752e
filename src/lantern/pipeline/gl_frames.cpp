// SPDX-License-Identifier: MIT
#include "lantern/gl/context.h"
#include "lantern/gl/timer.h"
#include "lantern/pipeline/frames.h"
#include "lantern/pipeline/raster_options.h"
#include "lantern/pipeline/render_job.h"
#include "lantern/pipeline/stopwatch.h"
#include "lantern/scene/subdivide.h"
#include "lantern/trace/embree.h"

#include <algorithm>

namespace lantern {
namespace {

/// Who walks through a scene sees the same lights for seconds at least.
constexpr std::size_t kFramesOfLights = 100;

}  // namespace

FramePoint measure_frames(const Scene& scene, const FrameRun& run, const VirtualLights& lights,
                          double seconds, const StopFlag& stop) {
  const RenderOptions& options = run.options;
  const World given = make_traceable_world(scene);
  const Camera camera =
      choose_camera(scene, given, *make_embree_tracer(scene, given), options.camera,
                    static_cast<float>(options.width) / static_cast<float>(options.height));
  const World world = subdivided(given, run.pieces);
  const gl::Context context({.api = {}, .device = options.gl_device});
  RasterOptions with = raster_options(options);
  with.samples_of_lights = kFramesOfLights;
  Rasteriser rasteriser(scene, world, context.info(), with);
  gl::Timer timer;
  rasteriser.draw_frame(camera, lights, {}, 0);
  glFinish();

  FramePoint point;
  point.run = run;
  point.lights = lights.size();
  point.triangles = world.size();
  constexpr double kNever = 1e30;
  point.seconds = point.processor_seconds = kNever;
  constexpr std::size_t kLeastFrames = 3;
  const Stopwatch all;
  while ((point.frames < kLeastFrames || all.seconds() < seconds) && !stop.load()) {
    const Stopwatch watch;
    const double processor_before = processor_seconds();
    timer.begin();
    // The same sample each time, for the same work.
    rasteriser.draw_frame(camera, lights, {}, 0);
    timer.end();
    glFinish();
    ++point.frames;
    point.seconds = std::min(point.seconds, watch.seconds());
    point.processor_seconds =
        std::min(point.processor_seconds, processor_seconds() - processor_before);
    if (const std::optional<double> gpu = timer.seconds()) {
      point.gpu_seconds = std::min(*gpu, point.gpu_seconds.value_or(kNever));
    }
  }
  return point;
}

}  // namespace lantern
