// SPDX-License-Identifier: MIT
#include "lantern/sampling/sobol.h"

#include "lantern/core/hash.h"

#include <bit>
#include <cassert>

namespace lantern {
namespace {

constexpr int kBits = 32;

constexpr std::uint32_t mirror(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// A primitive polynomial over GF(2), x^s + a_1 x^(s-1) + ... + 1, and the first s odd numbers m_k.
struct Polynomial {
  int degree;
  std::uint32_t inner;  // the bits a_1 ... a_(s-1)
  std::uint32_t first[3];
};
/// Of dimensions 2 to 4; the first is the radical inverse in base 2. [Joe & Kuo 2008, table
/// new-joe-kuo-6]
constexpr Polynomial kPolynomials[] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}};

/// The columns of a generator matrix, as fractions of 2^32.
using Columns = std::array<std::uint32_t, kBits>;

/// m_k = 2 a_1 m_(k-1) ⊕ ... ⊕ 2^s m_(k-s) ⊕ m_(k-s), column k = m_k / 2^k.
constexpr Columns make_columns(const Polynomial& p) {
  Columns m{};
  for (int k = 0; k < kBits; ++k) {
    auto& value = m[static_cast<std::size_t>(k)];
    if (k < p.degree) {
      value = p.first[k];
      continue;
    }
    const std::uint32_t oldest = m[static_cast<std::size_t>(k - p.degree)];
    value = oldest ^ (oldest << p.degree);
    for (int i = 1; i < p.degree; ++i) {
      const bool a = ((p.inner >> (p.degree - 1 - i)) & 1u) != 0;
      if (a) value ^= m[static_cast<std::size_t>(k - i)] << i;
    }
  }
  for (int k = 0; k < kBits; ++k) m[static_cast<std::size_t>(k)] <<= kBits - 1 - k;
  return m;
}

constexpr auto kColumns = [] {
  std::array<Columns, kSobolDimensions> columns{};
  for (std::size_t k = 0; k < kBits; ++k) columns[0][k] = 1u << (kBits - 1 - k);
  for (std::size_t d = 1; d < kSobolDimensions; ++d) columns[d] = make_columns(kPolynomials[d - 1]);
  return columns;
}();

/// Flips each bit of a mirrored number depending on the key and on the bits below it, that is on
/// the digits before it: nested uniform scrambling. Sums and products carry only upwards, and
/// products with even numbers leave the lowest bit. [Laine & Karras 2011, section 3.1; Burley 2020,
/// section 4; his constants] Burley's sum with the key alone ties the second digit to the first:
/// here an odd factor has bits of its own.
constexpr std::uint32_t scramble(std::uint32_t x, std::uint64_t key) {
  x += static_cast<std::uint32_t>(key);
  x ^= x * 0x6c50b47cu;
  x *= static_cast<std::uint32_t>(key >> 32) | 1u;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

}  // namespace

ScrambledSobol::ScrambledSobol(std::uint32_t count) : points_(std::bit_ceil(count)) {
  assert(count >= 1 && count <= (1u << 24));
  for (std::uint32_t i = 1; i < points_.size(); ++i) {
    // One bit more than a point that is there already.
    const auto lowest = static_cast<std::size_t>(std::countr_zero(i));
    const Mirrored& before = points_[i & (i - 1)];
    for (std::size_t d = 0; d < kSobolDimensions; ++d) {
      points_[i][d] = before[d] ^ mirror(kColumns[d][lowest]);
    }
  }
}

Vec4 ScrambledSobol::at(std::uint32_t index, std::uint64_t seed) const {
  assert(index < count());
  std::uint64_t key = hash(seed);
  // Scrambled as a number of 32 digits the index stays within its power of two but for the digits
  // above, which are cut off.
  const std::uint32_t shuffled = mirror(scramble(mirror(index), key)) & (count() - 1);
  const Mirrored& x = points_[shuffled];
  Vec4 point;
  for (int d = 0; d < kSobolDimensions; ++d) {
    key = hash(key);
    const std::uint32_t bits = mirror(scramble(x[static_cast<std::size_t>(d)], key));
    point[d] = static_cast<float>(bits >> 8) * 0x1.0p-24f;
  }
  return point;
}

}  // namespace lantern
