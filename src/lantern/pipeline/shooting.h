// SPDX-License-Identifier: MIT
// What the methods that shoot share: shots until the cutoff, the stop or the time, and what is
// known then. A `Solution` is a ProgressiveRadiosity or a GpuRadiosity.
#pragma once

#include "lantern/pipeline/radiosity_rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lantern {

/// The share of the flux that was shot, of what is to be; the time left as if what is unshot fell
/// by the same factor every second.
inline Progress progress_of(double unshot, double cutoff, double seconds) {
  Progress progress;
  progress.share = std::min(1.0, (1.0 - unshot) / (1.0 - cutoff));
  const double done = cutoff > 0.0 ? std::log(unshot) / std::log(cutoff) : 0.0;
  progress.seconds_left = done > 0.0 ? std::max(0.0, seconds * (1.0 / done - 1.0))
                                     : std::numeric_limits<double>::infinity();
  return progress;
}

template <typename Solution>
RadiositySolution shoot(const RenderJob& job, Solution& solution, RadiosityStatistics& statistics) {
  const RadiosityOptions& options = job.options.radiosity;
  const Stopwatch watch;
  while (!job.stop.load() && in_time(job) && solution.shoot()) {
    if (!job.report) continue;
    Progress progress = progress_of(solution.unshot_share(), options.cutoff, watch.seconds());
    progress.passes_done = statistics.rounds;
    job.report(progress);
  }
  statistics.shots = solution.shots();
  statistics.unshot_share = solution.unshot_share();
  statistics.conservation_error = solution.balance().error();
  std::vector<glm::dvec3> irradiance = solution.irradiance();
  if (options.ambient) {
    const glm::dvec3 ambient = solution.ambient();
    for (glm::dvec3& value : irradiance) value += ambient;
  }
  return {std::move(irradiance), std::max(0.0, statistics.unshot_share - options.cutoff)};
}

}  // namespace lantern
