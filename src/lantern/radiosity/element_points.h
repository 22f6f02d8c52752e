// SPDX-License-Identifier: MIT
// Where rays to and from elements start and end: points spread over the exposed part of each, and,
// to compare with, over the whole of it.
#pragma once

#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <vector>

namespace lantern {

class ElementPoints {
 public:
  /// One in each sixteenth of the patch, anywhere within it.
  static constexpr std::size_t kPoints = 16;

  /// Takes rays only where a patch is partly covered. The same patches, the same points.
  ElementPoints(const World& world, const Tracer& tracer, const Patches& patches);

  /// Of the exposed part; a hair off the surface, on the element's side.
  const Vec3& at(std::size_t element, std::size_t k) const {
    return exposed_[element * kPoints + k];
  }
  /// Of the whole, covered or not. The same points where nothing is covered.
  const Vec3& on_whole(std::size_t element, std::size_t k) const {
    return whole_[element * kPoints + k];
  }

 private:
  std::vector<Vec3> exposed_, whole_;
};

}  // namespace lantern
