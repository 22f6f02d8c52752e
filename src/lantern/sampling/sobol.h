// SPDX-License-Identifier: MIT
// The Sobol' sequence in four dimensions, randomised by nested uniform scrambling: a table of its
// first points, and a new order and new digits of them for every seed. Values lie in [0, 1).
// [Sobol' 1967; Owen 1995; direction numbers: Joe & Kuo 2008; by hashes: Burley 2020]
#pragma once

#include "lantern/core/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lantern {

inline constexpr int kSobolDimensions = 4;

/// The first `count` points, rounded up to a power of two (at most 2^24).
class ScrambledSobol {
 public:
  explicit ScrambledSobol(std::uint32_t count);

  std::uint32_t count() const { return static_cast<std::uint32_t>(points_.size()); }

  /// Point number `index` (below count()) of the randomisation `seed`. Points of the same seed are
  /// well spread together, above all in their first two dimensions and the more so if they are a
  /// power of two from 0 on; those of different seeds are independent. All are uniform.
  Vec4 at(std::uint32_t index, std::uint64_t seed) const;

 private:
  // Bits mirrored: the first binary digit behind the point is the lowest.
  using Mirrored = std::array<std::uint32_t, kSobolDimensions>;
  std::vector<Mirrored> points_;
};

}  // namespace lantern
