// SPDX-License-Identifier: MIT
// Patches -> the matrix of form factors between their elements. F_ij is the share of what leaves i
// that arrives at j. Each pair is computed once, so that A_i F_ij = A_j F_ji holds to the rounding
// of float, in which the matrix is kept; nothing is normalised. [Goral et al. 1984, section 3]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lantern {

struct FormFactorCounts {
  std::uint64_t open_pairs = 0;      // that see each other with nothing between: no rays
  std::uint64_t screened_pairs = 0;  // that something may stand between: sampled
  std::uint64_t rays = 0;
};

/// Called from any thread, one call at a time, with the share that is done and the seconds that the
/// whole assembly is expected to take.
using AssemblyReport = std::function<void(double share, double seconds_expected)>;

class FormFactors {
 public:
  /// Where something may be between two elements, the share of kRays rays that pass, weighted by
  /// what they would carry, scales the unoccluded factor: that share has a standard error of at
  /// most 1/8. Where one emits, or is covered in part and close, kManyRays do: at most 1/32. Ends
  /// early once `stop` is set.
  static constexpr std::size_t kRays = 16;
  static constexpr std::size_t kManyRays = 256;

  FormFactors(const World& world, const Tracer& tracer, const Patches& patches,
              const StopFlag& stop, const AssemblyReport& report = {});

  /// Of factors found in another way: a square matrix, row by row.
  explicit FormFactors(std::vector<float> values);

  /// Bytes that the matrix of so many elements takes.
  static std::uint64_t bytes(std::size_t elements) {
    return static_cast<std::uint64_t>(elements) * elements * sizeof(float);
  }

  std::size_t size() const { return size_; }
  std::span<const float> row(std::size_t i) const { return {values_.data() + i * size_, size_}; }
  const FormFactorCounts& counts() const { return counts_; }

 private:
  std::size_t size_;
  std::vector<float> values_;
  FormFactorCounts counts_;
};

/// How the rows add up, over the elements that are exposed: in a closed room to 1, and what is
/// missing elsewhere leaves the scene.
struct RowSums {
  double least = 0.0, mean = 0.0, most = 0.0;
};
RowSums row_sums(const Patches& patches, const FormFactors& factors);

/// Σ |A_i F_ij - A_j F_ji| / Σ A_i F_ij over all pairs: 0 where what i sends j is what j sends i.
double reciprocity_error(const Patches& patches, const FormFactors& factors);

}  // namespace lantern
