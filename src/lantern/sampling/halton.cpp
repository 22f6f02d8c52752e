// SPDX-License-Identifier: MIT
#include "lantern/sampling/halton.h"

#include "lantern/core/hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>

namespace lantern {
namespace {

/// Below this dimension (bases 2, 3, 5, 7) a few points are well distributed as they are; two
/// larger bases count up together along a diagonal for as many points as they are large.
constexpr int kPlainDimensions = 4;

/// Integers below it are exact in a double, so that one division of two of them rounds once and
/// does not depend on how many trailing zeros the digits carry.
constexpr std::uint64_t kExact = std::uint64_t{1} << 53;

/// Scrambled digits go on until they resolve this many steps, those of a float in [0.5, 1).
constexpr std::uint64_t kFloatSteps = std::uint64_t{1} << 24;

/// Division of 31-bit numbers by a constant as a multiplication: with 2^s <= b < 2^(s+1) and M =
/// ceil(2^(32+s) / b), floor(n M / 2^(32+s)) = floor(n / b), as the error n (M b - 2^(32+s)) is
/// below 2^31 b < 2^(32+s). [Granlund & Montgomery 1994]
class Base {
 public:
  constexpr Base() = default;
  explicit constexpr Base(std::uint32_t base)
      : base_(base),
        shift_(31 + static_cast<int>(std::bit_width(base))),
        multiplier_(((std::uint64_t{1} << shift_) - 1) / base + 1) {
    std::uint64_t cells = 1;
    for (; cells < kFloatSteps; cells *= base) ++scrambled_digits_;
    cell_ = 1.0 / static_cast<double>(cells);
  }

  constexpr std::uint32_t value() const { return base_; }
  constexpr int scrambled_digits() const { return scrambled_digits_; }
  constexpr double cell() const { return cell_; }
  constexpr std::uint64_t divide(std::uint64_t n) const {
    return n < (std::uint64_t{1} << 31) ? (n * multiplier_) >> shift_ : n / base_;
  }

 private:
  std::uint32_t base_ = 0;
  int shift_ = 0;
  std::uint64_t multiplier_ = 0;
  int scrambled_digits_ = 0;
  double cell_ = 0.0;  // base^-scrambled_digits
};

constexpr auto kBases = [] {
  constexpr std::size_t kLastPrime = 8161;  // the 1024th
  std::array<bool, kLastPrime + 1> composite{};
  std::array<Base, kHaltonDimensions> bases{};
  std::size_t count = 0;
  for (std::size_t n = 2; n <= kLastPrime; ++n) {
    if (composite[n]) continue;
    bases[count++] = Base(static_cast<std::uint32_t>(n));
    for (std::size_t m = n * n; m <= kLastPrime; m += n) composite[m] = true;
  }
  return bases;
}();
static_assert(kBases.back().value() == 8161);

/// Digits that do not fit the 53 bits are cut off, here and in the incremental form.
double plain(const Base& base, std::uint64_t index) {
  std::uint64_t numerator = 0, denominator = 1;
  while (index != 0 && denominator <= (kExact - 1) / base.value()) {
    const std::uint64_t quotient = base.divide(index);
    numerator = numerator * base.value() + (index - quotient * base.value());
    denominator *= base.value();
    index = quotient;
  }
  return static_cast<double>(numerator) / static_cast<double>(denominator);
}

/// Nested scrambling in base 2, where a permutation is one bit: a hash has enough of them for the
/// 31 prefixes that five more digits can have, numbered 1, 2..3, 4..7, ... as the nodes of a tree.
double scrambled_binary(std::uint64_t index, std::uint64_t key) {
  constexpr int kDigits = 25, kDigitsPerHash = 5;
  static_assert(kDigits % kDigitsPerHash == 0 && std::uint64_t{1} << kDigits >= kFloatSteps);
  std::uint64_t numerator = 0;
  for (int position = 0; position < kDigits; position += kDigitsPerHash) {
    const std::uint64_t place = std::uint64_t{1} << position;
    const std::uint64_t flips = hash(key + place + (index & (place - 1)));
    std::uint64_t node = 1;
    for (int k = 0; k < kDigitsPerHash; ++k) {
      const std::uint64_t digit = (index >> (position + k)) & 1u;
      numerator = 2 * numerator + (digit ^ ((flips >> node) & 1u));
      node = 2 * node + digit;
    }
  }
  return static_cast<double>(numerator) / static_cast<double>(std::uint64_t{1} << kDigits);
}

/// Nested scrambling in a prime base. The permutation of a digit d is d -> a d + c (mod b), a in
/// 1..b-1 and c in 0..b-1 hashed from the digits before it; the place b^k in front of them tells
/// prefixes of unequal length apart. These maps carry every pair of digits to every pair alike, and
/// the variance of nested uniform scrambling rests on pairs alone. The zeros behind the last digit
/// of the index are permuted as well, else small indices would stay on a lattice.
double scrambled(const Base& base, std::uint64_t index, std::uint64_t seed) {
  const std::uint64_t key = hash(seed);  // near seeds must not share the numbers hashed below
  const std::uint64_t b = base.value();
  if (b == 2) return scrambled_binary(index, key);
  std::uint64_t numerator = 0, prefix = 0, place = 1;
  for (int k = 0; k < base.scrambled_digits(); ++k) {
    const std::uint64_t quotient = base.divide(index);
    const std::uint64_t digit = index - quotient * b;
    const std::uint64_t bits = hash(key + place + prefix);
    const std::uint64_t a = 1 + (((bits >> 32) * (b - 1)) >> 32);
    const std::uint64_t c = ((bits & 0xffffffffu) * b) >> 32;
    const std::uint64_t image = a * digit + c;
    numerator = numerator * b + (image - base.divide(image) * b);
    prefix += digit * place;
    place *= b;
    index = quotient;
  }
  return static_cast<double>(numerator) * base.cell();
}

}  // namespace

std::uint32_t halton_base(int dimension) {
  assert(dimension >= 0 && dimension < kHaltonDimensions);
  return kBases[static_cast<std::size_t>(dimension)].value();
}

double radical_inverse(std::uint32_t base, std::uint64_t index) {
  assert(base >= 2);
  return plain(Base(base), index);
}

double scrambled_radical_inverse(std::uint32_t base, std::uint64_t index, std::uint64_t seed) {
  assert(base >= 2);
  return scrambled(Base(base), index, seed);
}

IncrementalRadicalInverse::IncrementalRadicalInverse(std::uint32_t base) : base_(base) {
  assert(base >= 2);
  for (; denominator_ <= (kExact - 1) / base; denominator_ *= base) {
    weights_.push_back(denominator_);
  }
  std::reverse(weights_.begin(), weights_.end());
  digits_.resize(weights_.size());
}

double IncrementalRadicalInverse::value() const {
  return static_cast<double>(numerator_) / static_cast<double>(denominator_);
}

void IncrementalRadicalInverse::next() {
  for (std::size_t k = 0; k < digits_.size(); ++k) {
    if (++digits_[k] < base_) {
      numerator_ += weights_[k];
      return;
    }
    digits_[k] = 0;
    numerator_ -= weights_[k] * (base_ - 1);
  }
}

float PointSet::at(std::uint64_t index, int dimension) const {
  assert(dimension >= 0);
  const auto d = static_cast<std::uint64_t>(dimension);
  if (sampler == Sampler::kRandom || dimension >= kHaltonDimensions) {
    return to_unit_float(hash(seed, d, index));
  }
  const Base& base = kBases[d];
  const bool is_plain = sampler == Sampler::kHalton && seed == 0 && dimension < kPlainDimensions;
  const double value = is_plain ? plain(base, index) : scrambled(base, index, hash(seed, d));
  return std::min(static_cast<float>(value), kBelowOne);
}

}  // namespace lantern
