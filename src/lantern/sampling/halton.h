// SPDX-License-Identifier: MIT
// The Halton sequence: the radical inverse of an index in the base of each dimension, directly and
// incrementally, plain or scrambled. Values lie in [0, 1). [Halton & Smith 1964]
#pragma once

#include <cstdint>
#include <vector>

namespace lantern {

/// Dimensions with a prime base of their own; beyond them values are hashed, not quasi-random.
inline constexpr int kHaltonDimensions = 1024;

/// The prime of a dimension: 2, 3, 5, ... `dimension` in [0, kHaltonDimensions).
std::uint32_t halton_base(int dimension);

/// The digits of `index` in `base`, mirrored about the point: Φ_b(i) = Σ d_k b^(-k-1).
double radical_inverse(std::uint32_t base, std::uint64_t index);

/// The radical inverse with each digit permuted at random, the permutation depending on the digits
/// before it: nested uniform scrambling [Owen 1995], driven by `seed`. `base` must be prime.
/// Resolves the steps of a float: 2^-24 or less.
double scrambled_radical_inverse(std::uint32_t base, std::uint64_t index, std::uint64_t seed);

/// The radical inverses of 0, 1, 2, ... without division: the mirrored digits are counted up with a
/// carry that runs away from the point. Equals radical_inverse() to the last bit.
class IncrementalRadicalInverse {
 public:
  explicit IncrementalRadicalInverse(std::uint32_t base);
  double value() const;
  void next();

 private:
  std::uint32_t base_;
  std::vector<std::uint32_t> digits_;
  std::vector<std::uint64_t> weights_;  // of each digit in the numerator, base^(count - 1 - k)
  std::uint64_t numerator_ = 0;
  std::uint64_t denominator_ = 1;
};

enum class Sampler {
  kHalton,     // plain in the first dimensions, scrambled where the base is deep; the default
  kScrambled,  // every dimension scrambled
  kRandom,     // independent hashed values
};

/// A point set of many dimensions: at(index, dimension) is a pure function. With kHalton and seed 0
/// the first dimensions are the plain sequence; any other seed scrambles them too.
struct PointSet {
  Sampler sampler = Sampler::kHalton;
  std::uint64_t seed = 0;

  float at(std::uint64_t index, int dimension) const;
};

}  // namespace lantern
