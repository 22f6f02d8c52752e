// SPDX-License-Identifier: MIT
#include "lantern/pipeline/radiosity_rounds.h"

#include "lantern/radiosity/refinement.h"

#include <cmath>
#include <utility>

namespace lantern {

namespace {

/// Of the patches from round to round: matrices that grow so take a third of the last one's time
/// together.
constexpr double kGrowth = 2.0;

}  // namespace

bool in_time(const RenderJob& job) {
  return !job.options.seconds || job.elapsed + job.watch.seconds() < *job.options.seconds;
}

Rendered render_in_rounds(const RenderJob& job, int refinements, const SolveRound& solve) {
  const RadiosityOptions& options = job.options.radiosity;
  // Patches of a given size are that size; of a given count the first are fewer, and the rest go
  // where they are needed.
  refinements = options.patches.size ? 0 : options.refinements.value_or(refinements);
  const auto count_before = [&](int rounds) {
    return static_cast<std::size_t>(static_cast<double>(options.patches.count) /
                                    std::pow(kGrowth, rounds));
  };
  PatchOptions first = options.patches;
  first.count = count_before(refinements);
  if (refinements > 0) require_patch_memory(options.patches.count);
  RadiosityStage stage(job, make_patches(job.scene, job.world, job.tracer, first));
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  statistics.seconds_prepare = job.watch.seconds();

  const Stopwatch solving;
  RadiositySolution solution = solve(stage, statistics.radiosity);
  for (int left = refinements; left > 0 && !job.stop.load() && in_time(job); --left) {
    PatchMesh mesh = stage.patches.mesh;
    refine_highest(mesh, variations(stage.patches, solution.irradiance), kVariationOfHalf,
                   count_before(left - 1));
    if (mesh.size() == stage.patches.size()) continue;
    RadiosityStage finer(
        job, make_patches(job.scene, job.world, job.tracer, std::move(mesh), stage.patches.lit));
    RadiosityStatistics of_finer;
    of_finer.rounds = statistics.radiosity.rounds + 1;
    RadiositySolution better = solve(finer, of_finer);
    if (better.missing > solution.missing) break;
    stage = std::move(finer);
    solution = std::move(better);
    statistics.radiosity = of_finer;
  }
  statistics.seconds_lights = solving.seconds();
  statistics.radiosity.patches = stage.patches.size();
  statistics.radiosity.elements = stage.patches.elements();

  const Stopwatch drawing;
  result.image = draw(job, stage.patches, solution.irradiance);
  statistics.seconds_gather = drawing.seconds();
  statistics.passes = 1;
  return result;
}

}  // namespace lantern
