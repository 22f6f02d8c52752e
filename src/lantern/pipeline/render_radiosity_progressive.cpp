// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_progressive.h"

#include "lantern/pipeline/radiosity_stage.h"
#include "lantern/radiosity/progressive.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lantern {
namespace {

/// The share of the flux that was shot, of what is to be; the time left as if what is unshot fell
/// by the same factor every second.
Progress progress_of(const ProgressiveRadiosity& solution, double cutoff, double seconds) {
  const double unshot = solution.unshot_share();
  Progress progress;
  progress.share = std::min(1.0, (1.0 - unshot) / (1.0 - cutoff));
  const double done = cutoff > 0.0 ? std::log(unshot) / std::log(cutoff) : 0.0;
  progress.seconds_left = done > 0.0 ? std::max(0.0, seconds * (1.0 / done - 1.0))
                                     : std::numeric_limits<double>::infinity();
  return progress;
}

}  // namespace

Rendered render_radiosity_progressive(const RenderJob& job) {
  const RadiosityOptions& options = job.options.radiosity;
  const RadiosityStage stage(job);
  ProgressiveRadiosity solution(job.world, job.tracer, stage.patches,
                                {.cutoff = options.cutoff, .hemicube = options.hemicube},
                                stage.external);
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  statistics.seconds_prepare = job.watch.seconds();

  const Stopwatch shooting;
  const auto in_time = [&] {
    return !job.options.seconds || job.elapsed + job.watch.seconds() < *job.options.seconds;
  };
  while (!job.stop.load() && in_time() && solution.shoot()) {
    if (job.report) job.report(progress_of(solution, options.cutoff, shooting.seconds()));
  }
  std::vector<glm::dvec3> irradiance = solution.irradiance();
  if (options.ambient) {
    const glm::dvec3 ambient = solution.ambient();
    for (glm::dvec3& value : irradiance) value += ambient;
  }
  statistics.seconds_lights = shooting.seconds();

  const Stopwatch drawing;
  result.image = draw(job, stage.patches, irradiance);
  statistics.seconds_gather = drawing.seconds();
  statistics.passes = 1;
  statistics.radiosity.patches = stage.patches.size();
  statistics.radiosity.elements = stage.patches.elements();
  statistics.radiosity.hemicubes = solution.hemicubes();
  statistics.radiosity.shots = solution.shots();
  statistics.radiosity.unshot_share = solution.unshot_share();
  statistics.radiosity.conservation_error = solution.balance().error();
  return result;
}

}  // namespace lantern
