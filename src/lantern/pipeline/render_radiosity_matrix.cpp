// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_matrix.h"

#include "lantern/pipeline/radiosity_stage.h"
#include "lantern/radiosity/refinement.h"
#include "lantern/radiosity/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lantern {
namespace {

/// Matrices that grow by this from round to round take a third of the last one's time together.
constexpr double kGrowth = 2.0;

std::uint64_t bytes_beside(std::size_t elements, Solver solver) {
  return solver == Solver::kElimination ? elimination_bytes(elements) : 0;
}

/// One matrix: assembled and solved, its memory and time told beforehand.
class Round {
 public:
  Round(const RenderJob& job, const RadiosityStage& stage) : job_(job), stage_(stage) {}

  std::vector<glm::dvec3> solve(RadiosityStatistics& statistics) {
    const Solver solver = job_.options.radiosity.solver;
    const std::size_t n = stage_.patches.elements();
    require_matrix_memory(n, bytes_beside(n, solver));
    const double solving = solver == Solver::kElimination ? elimination_seconds(stage_.patches)
                                                          : gauss_seidel_seconds(stage_.patches);
    statistics.bytes_expected = FormFactors::bytes(n) + bytes_beside(n, solver);
    double expected = 0.0;
    const Stopwatch watch;
    const FormFactors factors(job_.world, job_.tracer, stage_.patches, job_.stop,
                              [&](double share, double assembly) {
                                // By then blocks from all over the matrix are done.
                                constexpr double kTelling = 0.03;
                                if (expected == 0.0 && share >= kTelling) {
                                  expected = assembly + solving;
                                  tell(statistics.bytes_expected, expected);
                                }
                                if (!job_.report) return;
                                const double done = share * assembly, whole = assembly + solving;
                                job_.report({done / whole, whole - done, statistics.rounds});
                              });
    statistics.seconds_expected = expected;
    std::vector<glm::dvec3> irradiance = solve_for(factors, statistics);
    statistics.seconds_matrix = watch.seconds();
    statistics.form_factors = factors.counts();
    statistics.row_sums = row_sums(stage_.patches, factors);
    statistics.reciprocity_error = reciprocity_error(stage_.patches, factors);
    return irradiance;
  }

 private:
  std::vector<glm::dvec3> solve_for(const FormFactors& factors,
                                    RadiosityStatistics& statistics) const {
    if (job_.options.radiosity.solver == Solver::kElimination) {
      return solve_by_elimination(stage_.patches, factors, stage_.external);
    }
    GaussSeidelResult solution =
        solve_by_gauss_seidel(stage_.patches, factors, stage_.external, {}, job_.stop);
    statistics.sweeps = solution.sweeps;
    return std::move(solution.irradiance);
  }

  void tell(std::uint64_t bytes, double seconds) const {
    if (!job_.options.notice) return;
    constexpr double kMegabyte = 1e6;
    job_.options.notice(fmt::format("{} patches, {} sides: a matrix of {:.0f} MB, about {:.1f} s",
                                    stage_.patches.size(), stage_.patches.elements(),
                                    static_cast<double>(bytes) / kMegabyte, seconds));
  }

  const RenderJob& job_;
  const RadiosityStage& stage_;
};

/// Rows add up to more than 1 only by the error of sampling; light would be made out of nothing.
void warn_of_rows(const RadiosityStatistics& statistics, std::vector<std::string>& warnings) {
  constexpr double kTooMuch = 1.1;
  if (statistics.row_sums.most <= kTooMuch) return;
  warnings.push_back(
      fmt::format("form factors of a patch add up to {:.3f}, which should not pass 1: take smaller "
                  "patches",
                  statistics.row_sums.most));
}

}  // namespace

Rendered render_radiosity_matrix(const RenderJob& job) {
  const RadiosityOptions& options = job.options.radiosity;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  RadiosityStatistics& of_radiosity = statistics.radiosity;
  const std::size_t least = least_elements(job);
  require_matrix_memory(least, bytes_beside(least, options.solver));
  // Patches of a given size are that size; of a given count the first are fewer, and the rest go
  // where they are needed.
  const int refinements = options.patches.size ? 0 : options.refinements;
  PatchOptions first = options.patches;
  first.count =
      static_cast<std::size_t>(static_cast<double>(first.count) / std::pow(kGrowth, refinements));
  RadiosityStage stage(job, make_patches(job.scene, job.world, job.tracer, first));
  statistics.seconds_prepare = job.watch.seconds();

  const Stopwatch solving;
  std::vector<glm::dvec3> irradiance = Round(job, stage).solve(of_radiosity);
  for (int left = refinements; left > 0 && !job.stop.load(); --left) {
    PatchMesh mesh = stage.patches.mesh;
    refine_highest(mesh, variations(stage.patches, irradiance), kVariationOfHalf,
                   static_cast<std::size_t>(static_cast<double>(options.patches.count) /
                                            std::pow(kGrowth, left - 1)));
    if (mesh.size() == stage.patches.size()) break;
    RadiosityStage finer(
        job, make_patches(job.scene, job.world, job.tracer, std::move(mesh), stage.patches.lit));
    RadiosityStatistics of_finer = of_radiosity;
    ++of_finer.rounds;
    std::vector<glm::dvec3> better = Round(job, finer).solve(of_finer);
    if (job.stop.load()) break;
    stage = std::move(finer);
    irradiance = std::move(better);
    of_radiosity = of_finer;
  }
  statistics.seconds_lights = solving.seconds();
  of_radiosity.patches = stage.patches.size();
  of_radiosity.elements = stage.patches.elements();
  warn_of_rows(of_radiosity, result.warnings);

  const Stopwatch drawing;
  result.image = draw(job, stage.patches, irradiance);
  statistics.seconds_gather = drawing.seconds();
  statistics.passes = 1;
  return result;
}

}  // namespace lantern
