// SPDX-License-Identifier: MIT
// Evenly distributed numbers for tests, the same in every run.
#pragma once

#include "lantern/core/hash.h"
#include "lantern/core/math.h"

#include <cstddef>
#include <cstdint>

namespace lantern::test {

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : seed_(seed) {}
  float in(float low, float high) {
    return low + (high - low) * to_unit_float(hash(seed_, next_++));
  }
  Vec3 in_box(float half) {
    const float x = in(-half, half), y = in(-half, half);
    return {x, y, in(-half, half)};
  }
  std::uint32_t below(std::size_t n) {
    return static_cast<std::uint32_t>(hash(seed_, next_++) % n);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

}  // namespace lantern::test
