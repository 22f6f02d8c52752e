// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_hemicube.h"

#include "lantern/pipeline/radiosity_stage.h"
#include "lantern/radiosity/hemicube_matrix.h"
#include "lantern/radiosity/solve.h"

namespace lantern {

Rendered render_radiosity_hemicube(const RenderJob& job) {
  const RadiosityOptions& options = job.options.radiosity;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  RadiosityStatistics& of_radiosity = statistics.radiosity;
  require_matrix_memory(least_elements(job));
  const RadiosityStage stage(job);
  of_radiosity.patches = stage.patches.size();
  of_radiosity.elements = stage.patches.elements();
  require_matrix_memory(stage.patches.elements());
  statistics.seconds_prepare = job.watch.seconds();

  const Stopwatch solving;
  const FormFactors factors = hemicube_form_factors(
      job.world, job.tracer, stage.patches, options.hemicube, job.stop, [&](double share) {
        if (job.report) job.report({share, solving.seconds() * (1.0 / share - 1.0), 0});
      });
  GaussSeidelResult solution =
      solve_by_gauss_seidel(stage.patches, factors, stage.external, {}, job.stop);
  statistics.seconds_lights = solving.seconds();
  of_radiosity.hemicubes = stage.patches.elements();
  of_radiosity.row_sums = row_sums(stage.patches, factors);
  of_radiosity.reciprocity_error = reciprocity_error(stage.patches, factors);
  of_radiosity.sweeps = solution.sweeps;

  const Stopwatch drawing;
  result.image = draw(job, stage.patches, solution.irradiance);
  statistics.seconds_gather = drawing.seconds();
  statistics.passes = 1;
  return result;
}

}  // namespace lantern
