// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_gpu.h"

#include "lantern/gl/context.h"
#include "lantern/pipeline/radiosity_stage.h"
#include "lantern/radiosity_gl/gpu_radiosity.h"
#include "lantern/scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lantern {
namespace {

/// The share of the flux that was shot, of what is to be; the time left as if what is unshot fell
/// by the same factor every second.
Progress progress_of(double unshot, double cutoff, double seconds) {
  Progress progress;
  progress.share = std::min(1.0, (1.0 - unshot) / (1.0 - cutoff));
  const double done = cutoff > 0.0 ? std::log(unshot) / std::log(cutoff) : 0.0;
  progress.seconds_left = done > 0.0 ? std::max(0.0, seconds * (1.0 / done - 1.0))
                                     : std::numeric_limits<double>::infinity();
  return progress;
}

/// Shoots until the cutoff, the stop or the time.
std::vector<glm::dvec3> solve(const RenderJob& job, const RadiosityStage& stage,
                              RadiosityStatistics& statistics) {
  const RadiosityOptions& options = job.options.radiosity;
  GpuRadiosity solution(job.world, job.tracer, stage.patches, stage.external,
                        {.hemicube = options.hemicube.resolution,
                         .cutoff = options.cutoff,
                         .limits = {},
                         .seed = options.hemicube.seed});
  const Stopwatch watch;
  const auto in_time = [&] {
    return !job.options.seconds || job.elapsed + job.watch.seconds() < *job.options.seconds;
  };
  while (!job.stop.load() && in_time() && solution.shoot()) {
    if (job.report) {
      job.report(progress_of(solution.unshot_share(), options.cutoff, watch.seconds()));
    }
  }
  statistics.patches = stage.patches.size();
  statistics.elements = stage.patches.elements();
  statistics.shots = statistics.hemicubes = solution.shots();
  statistics.unshot_share = solution.unshot_share();
  statistics.conservation_error = solution.balance().error();
  std::vector<glm::dvec3> irradiance = solution.irradiance();
  if (options.ambient) {
    const glm::dvec3 ambient = solution.ambient();
    for (glm::dvec3& value : irradiance) value += ambient;
  }
  return irradiance;
}

void warn_of_holes(const Scene& scene, std::vector<std::string>& warnings) {
  for (const Material& material : scene.materials) {
    if (!has_holes(material)) continue;
    warnings.push_back(
        fmt::format("material '{}' has holes; radiosity-gpu lets no light through", material.name));
  }
}

}  // namespace

Rendered render_radiosity_gpu(const RenderJob& job) {
  const gl::Context context;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  warn_of_holes(job.scene, result.warnings);
  const RadiosityStage stage(job);
  statistics.seconds_prepare = job.watch.seconds();

  const Stopwatch shooting;
  const std::vector<glm::dvec3> irradiance = solve(job, stage, statistics.radiosity);
  statistics.seconds_lights = shooting.seconds();

  const Stopwatch drawing;
  result.image = draw(job, stage.patches, irradiance);
  statistics.seconds_gather = drawing.seconds();
  statistics.passes = 1;
  return result;
}

}  // namespace lantern
