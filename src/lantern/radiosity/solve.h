// SPDX-License-Identifier: MIT
// B = E + ρ (H + F B): the matrix of form factors, what elements emit and what light without area
// brings them -> their irradiance H + F B in W/m², per channel. [Goral et al. 1984, equation 7]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/patches.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lantern {

enum class Solver { kGaussSeidel, kElimination };

/// Bytes that solve_by_elimination() takes beside the form factors.
std::uint64_t elimination_bytes(std::size_t elements);

/// Seconds that it takes for these patches, from the time that a small matrix takes.
double elimination_seconds(const Patches& patches);

/// Gaussian elimination with partial pivoting (Eigen), one matrix for each set of channels whose
/// reflectances are the same.
std::vector<glm::dvec3> solve_by_elimination(const Patches& patches, const FormFactors& factors,
                                             std::span<const glm::dvec3> external);

struct GaussSeidelOptions {
  double tolerance = 1e-9;  // on the change of radiosity in a sweep, relative to the largest
  int most_sweeps = 10'000;
};

/// Seconds that the sweeps are expected to take: their number from the mean reflectance, one from a
/// trial of its arithmetic.
double gauss_seidel_seconds(const Patches& patches);

struct GaussSeidelResult {
  std::vector<glm::dvec3> irradiance;
  int sweeps = 0;
  double change = 0.0;  // in the last sweep, relative to the largest radiosity
};

/// Sweeps over the elements until nothing changes. `external` is H. Ends after the sweep in which
/// `stop` is set.
GaussSeidelResult solve_by_gauss_seidel(const Patches& patches, const FormFactors& factors,
                                        std::span<const glm::dvec3> external,
                                        const GaussSeidelOptions& options, const StopFlag& stop);

}  // namespace lantern
