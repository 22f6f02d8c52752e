// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_progressive.h"

#include "lantern/pipeline/shooting.h"
#include "lantern/radiosity/progressive.h"

namespace lantern {
namespace {

/// Shots take about as long whatever the number of patches: more of one size cost less than rounds.
constexpr int kRefinements = 0;

}  // namespace

Rendered render_radiosity_progressive(const RenderJob& job) {
  const RadiosityOptions& options = job.options.radiosity;
  return render_in_rounds(
      job, kRefinements, [&](const RadiosityStage& stage, RadiosityStatistics& statistics) {
        ProgressiveRadiosity radiosity(job.world, job.tracer, stage.patches,
                                       {.cutoff = options.cutoff, .hemicube = options.hemicube},
                                       stage.external);
        RadiositySolution solution = shoot(job, radiosity, statistics);
        statistics.hemicubes = radiosity.hemicubes();
        return solution;
      });
}

}  // namespace lantern
