// SPDX-License-Identifier: MIT
// Where rays to and from elements start and end: points spread over the exposed part of each.
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

  /// A hair off the surface, on the element's side.
  const Vec3& at(std::size_t element, std::size_t k) const {
    return points_[element * kPoints + k];
  }

 private:
  std::vector<Vec3> points_;
};

}  // namespace lantern
