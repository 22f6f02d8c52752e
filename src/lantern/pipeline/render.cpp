// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render.h"

#include "lantern/core/error.h"
#include "lantern/pipeline/render_instant_radiosity.h"
#include "lantern/pipeline/render_job.h"
#include "lantern/pipeline/render_path.h"
#include "lantern/pipeline/render_radiosity_gpu.h"
#include "lantern/pipeline/render_radiosity_hemicube.h"
#include "lantern/pipeline/render_radiosity_matrix.h"
#include "lantern/pipeline/render_radiosity_progressive.h"
#include "lantern/trace/embree.h"

#include <cassert>

namespace lantern {

World make_traceable_world(const Scene& scene) {
  World world = make_world(scene);
  if (world.size() == 0) throw Error("the scene has no triangles");
  return world;
}

void require_light(bool has_light) {
  if (has_light) return;
  throw Error(
      "the scene has no light: name materials that emit with --emitter 'PATTERN=R,G,B', or give "
      "--sky R,G,B");
}

Rendered render(const Scene& scene, const RenderOptions& options, const StopFlag& stop,
                const ProgressReport& report, double elapsed) {
  const Stopwatch watch;
  const World world = make_traceable_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const Camera camera =
      choose_camera(scene, world, *tracer, options.camera,
                    static_cast<float>(options.width) / static_cast<float>(options.height));
  const RenderJob job{scene, world, *tracer, camera, options, stop, report, watch, elapsed};
  switch (options.method) {
    case Method::kInstantRadiosity:
      return render_instant_radiosity(job);
    case Method::kPath:
      return render_path(job);
    case Method::kRadiosityMatrix:
      return render_radiosity_matrix(job);
    case Method::kRadiosityHemicube:
      return render_radiosity_hemicube(job);
    case Method::kRadiosityProgressive:
      return render_radiosity_progressive(job);
    case Method::kRadiosityGpu:
      return render_radiosity_gpu(job);
  }
  assert(false);
  return {};
}

}  // namespace lantern
