// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_hemicube.h"

#include "lantern/pipeline/gl_items.h"
#include "lantern/pipeline/radiosity_rounds.h"
#include "lantern/radiosity/hemicube_matrix.h"
#include "lantern/radiosity/solve.h"

#include <memory>
#include <utility>

namespace lantern {
namespace {

/// Time grows with the patches alone: as many more of one size cost no more than these rounds.
constexpr int kRefinements = 0;

}  // namespace

Rendered render_radiosity_hemicube(const RenderJob& job) {
  require_matrix_memory(least_elements(job));
  std::unique_ptr<HemicubePainter> painter;
  if (job.options.backend == Backend::kGl) painter = make_gl_painter(job);
  HemicubeOptions hemicube = job.options.radiosity.hemicube;
  hemicube.painter = painter.get();
  const auto solve = [&](const RadiosityStage& stage, RadiosityStatistics& statistics) {
    require_matrix_memory(stage.patches.elements());
    const Stopwatch watch;
    const auto [factors, hemicubes] = hemicube_matrix(
        job.world, job.tracer, stage.patches, hemicube, job.stop, [&](double share) {
          if (!job.report) return;
          job.report({share, watch.seconds() * (1.0 / share - 1.0), statistics.rounds});
        });
    GaussSeidelResult solution =
        solve_by_gauss_seidel(stage.patches, factors, stage.external, {}, job.stop);
    statistics.hemicubes = hemicubes;
    statistics.row_sums = row_sums(stage.patches, factors);
    statistics.reciprocity_error = reciprocity_error(stage.patches, factors);
    statistics.sweeps = solution.sweeps;
    return RadiositySolution{std::move(solution.irradiance), job.stop.load() ? 1.0 : 0.0};
  };
  return render_in_rounds(job, kRefinements, solve);
}

}  // namespace lantern
