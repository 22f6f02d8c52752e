// SPDX-License-Identifier: MIT
// Hashes that stand in for random numbers: pure functions, good in every bit.
#pragma once

#include <cstdint>

namespace lantern {

/// A bijection of 64 bits in which every input bit changes every output bit with probability one
/// half (the finaliser of SplitMix64). [Steele et al. 2014]
constexpr std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b) { return hash(hash(a) ^ b); }
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return hash(hash(a, b) ^ c);
}

/// The largest float of [0, 1).
inline constexpr float kBelowOne = 0x1.fffffep-1f;

/// The top 24 bits as a float in [0, 1).
constexpr float to_unit_float(std::uint64_t bits) {
  return static_cast<float>(bits >> 40) * 0x1.0p-24f;
}

}  // namespace lantern
