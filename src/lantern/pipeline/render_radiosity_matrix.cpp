// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_matrix.h"

#include "lantern/pipeline/radiosity_rounds.h"
#include "lantern/radiosity/solve.h"

#include <fmt/format.h>

#include <utility>

namespace lantern {
namespace {

/// A matrix grows with the square of the patches: they had better be where they are needed.
constexpr int kRefinements = 2;

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
  const Solver solver = job.options.radiosity.solver;
  const std::size_t least = least_elements(job);
  require_matrix_memory(least, bytes_beside(least, solver));
  Rendered result = render_in_rounds(
      job, kRefinements, [&](const RadiosityStage& stage, RadiosityStatistics& statistics) {
        std::vector<glm::dvec3> irradiance = Round(job, stage).solve(statistics);
        return RadiositySolution{std::move(irradiance), job.stop.load() ? 1.0 : 0.0};
      });
  warn_of_rows(result.statistics.radiosity, result.warnings);
  return result;
}

}  // namespace lantern
