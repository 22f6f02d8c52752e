// SPDX-License-Identifier: MIT
#include "lantern/radiosity/solve.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

namespace lantern {
namespace {

using Matrix = Eigen::MatrixXd;

/// For each channel the first whose reflectances are the same.
std::array<int, 3> channel_sets(const Patches& patches) {
  std::array<int, 3> first = {0, 1, 2};
  for (int c = 1; c < 3; ++c) {
    for (int earlier = c - 1; earlier >= 0; --earlier) {
      const bool same = std::all_of(patches.reflectance.begin(), patches.reflectance.end(),
                                    [&](const glm::dvec3& rho) { return rho[c] == rho[earlier]; });
      if (same) first[static_cast<std::size_t>(c)] = earlier;
    }
  }
  return first;
}

glm::dvec3 reflectance_of(const Patches& patches, std::size_t element) {
  return patches.reflectance[patches.patch[element]];
}

/// Σ_j F_ij B_j over [begin, end) in each channel; the sums of eight lanes, so that it is done in
/// vectors and yet in one order.
glm::dvec3 gathered(std::span<const float> row, const std::array<std::vector<double>, 3>& radiosity,
                    std::size_t begin, std::size_t end) {
  constexpr std::size_t kLanes = 8;
  double lanes[3][kLanes] = {};
  const double* const b[3] = {radiosity[0].data(), radiosity[1].data(), radiosity[2].data()};
  std::size_t j = begin;
  for (; j + kLanes <= end; j += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const auto f = static_cast<double>(row[j + k]);
      lanes[0][k] += f * b[0][j + k];
      lanes[1][k] += f * b[1][j + k];
      lanes[2][k] += f * b[2][j + k];
    }
  }
  for (; j < end; ++j) {
    for (int c = 0; c < 3; ++c) lanes[c][0] += static_cast<double>(row[j]) * b[c][j];
  }
  glm::dvec3 sum(0.0);
  for (int c = 0; c < 3; ++c) {
    for (const double lane : lanes[c]) sum[c] += lane;
  }
  return sum;
}

}  // namespace

std::uint64_t elimination_bytes(std::size_t elements) {
  return static_cast<std::uint64_t>(elements) * elements * sizeof(double);
}

double elimination_seconds(const Patches& patches) {
  constexpr Eigen::Index kProbe = 1024;
  // Of a few trials the fastest: what disturbs them only makes them slower.
  constexpr int kTrials = 3;
  double fastest = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < kTrials; ++trial) {
    Matrix probe = Matrix::Random(kProbe, kProbe);
    probe.diagonal().array() += static_cast<double>(kProbe);
    const auto start = std::chrono::steady_clock::now();
    const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factorised(probe);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    fastest = std::min(fastest, elapsed.count());
  }
  const std::array<int, 3> sets = channel_sets(patches);
  const auto matrices = std::count_if(sets.begin(), sets.end(), [&](const int& set) {
    return set == static_cast<int>(&set - sets.data());
  });
  const double larger = static_cast<double>(patches.elements()) / static_cast<double>(kProbe);
  return fastest * larger * larger * larger * static_cast<double>(matrices);
}

std::vector<glm::dvec3> solve_by_elimination(const Patches& patches, const FormFactors& factors,
                                             std::span<const glm::dvec3> external) {
  const std::size_t n = patches.elements();
  const auto size = static_cast<Eigen::Index>(n);
  const std::array<int, 3> sets = channel_sets(patches);
  std::array<std::vector<double>, 3> radiosity;
  for (int set = 0; set < 3; ++set) {
    if (sets[static_cast<std::size_t>(set)] != set) continue;
    // I - ρ F, overwritten by its factors.
    Matrix matrix(size, size);
    parallel_for(n, 16, [&](std::size_t i) {
      const double rho = reflectance_of(patches, i)[set];
      const std::span<const float> row = factors.row(i);
      for (std::size_t j = 0; j < n; ++j) {
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            (i == j ? 1.0 : 0.0) - rho * static_cast<double>(row[j]);
      }
    });
    const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factorised(matrix);
    for (int c = set; c < 3; ++c) {
      if (sets[static_cast<std::size_t>(c)] != set) continue;
      Eigen::VectorXd right(size);
      for (std::size_t i = 0; i < n; ++i) {
        right(static_cast<Eigen::Index>(i)) =
            patches.emission[i][c] + reflectance_of(patches, i)[c] * external[i][c];
      }
      const Eigen::VectorXd solution = factorised.solve(right);
      radiosity[static_cast<std::size_t>(c)].assign(solution.data(), solution.data() + size);
    }
  }
  std::vector<glm::dvec3> irradiance(n);
  parallel_for(n, 16, [&](std::size_t i) {
    irradiance[i] = external[i] + gathered(factors.row(i), radiosity, 0, n);
  });
  return irradiance;
}

double gauss_seidel_seconds(const Patches& patches) {
  // Larger than caches, so that memory counts as it will.
  constexpr std::size_t kTrial = std::size_t{1} << 24;
  const std::size_t n = patches.elements();
  const std::size_t rows = std::clamp<std::size_t>(kTrial / n, 1, n);
  const std::vector<float> trial(rows * n, 1.0f);
  std::array<std::vector<double>, 3> radiosity;
  radiosity.fill(std::vector<double>(n, 1.0));
  std::vector<glm::dvec3> sums(rows);
  const auto start = std::chrono::steady_clock::now();
  parallel_for(rows, 4, [&](std::size_t i) {
    sums[i] = gathered(std::span(trial).subspan(i * n, n), radiosity, 0, n);
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  glm::dvec3 reflected(0.0);
  double area = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    reflected += patches.area[i] * patches.reflectance[i];
    area += patches.area[i];
  }
  const double reflectance = std::max({reflected.r, reflected.g, reflected.b}) / area;
  // Sweeps converge about as two bounces of light each.
  const double sweeps = reflectance > 0.0
                            ? 0.5 * std::log(GaussSeidelOptions{}.tolerance) / std::log(reflectance)
                            : 1.0;
  return elapsed.count() * static_cast<double>(n) / static_cast<double>(rows) * (1.0 + sweeps);
}

GaussSeidelResult solve_by_gauss_seidel(const Patches& patches, const FormFactors& factors,
                                        std::span<const glm::dvec3> external,
                                        const GaussSeidelOptions& options, const StopFlag& stop) {
  // Rows of a block gather from outside of it side by side; from inside, what is small, in turn.
  constexpr std::size_t kBlock = 128;
  const std::size_t n = patches.elements();
  std::array<std::vector<double>, 3> radiosity;
  for (int c = 0; c < 3; ++c) {
    std::vector<double>& values = radiosity[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < n; ++i) values.push_back(patches.emission[i][c]);
  }
  GaussSeidelResult result;
  result.irradiance.assign(external.begin(), external.end());
  while (result.sweeps < options.most_sweeps) {
    glm::dvec3 change(0.0), largest(0.0);
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, n);
      parallel_for(end - begin, 4, [&](std::size_t k) {
        const std::size_t i = begin + k;
        result.irradiance[i] = external[i] + gathered(factors.row(i), radiosity, 0, begin) +
                               gathered(factors.row(i), radiosity, end, n);
      });
      for (std::size_t i = begin; i < end; ++i) {
        result.irradiance[i] += gathered(factors.row(i), radiosity, begin, end);
        const glm::dvec3 rho = reflectance_of(patches, i);
        for (int c = 0; c < 3; ++c) {
          double& value = radiosity[static_cast<std::size_t>(c)][i];
          const double next = patches.emission[i][c] + rho[c] * result.irradiance[i][c];
          change[c] = std::max(change[c], std::abs(next - value));
          largest[c] = std::max(largest[c], next);
          value = next;
        }
      }
    }
    ++result.sweeps;
    result.change = 0.0;
    for (int c = 0; c < 3; ++c) {
      if (largest[c] > 0.0) result.change = std::max(result.change, change[c] / largest[c]);
    }
    if (result.change <= options.tolerance || stop.load(std::memory_order_relaxed)) break;
  }
  return result;
}

}  // namespace lantern
