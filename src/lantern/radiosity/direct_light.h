// SPDX-License-Identifier: MIT
// What comes straight from emitting elements to each element, as a few rays tell it: not a solution
// but a guide to where one must look closely.
#pragma once

#include "lantern/radiosity/patches.h"

#include <vector>

namespace lantern {

struct DirectLight {
  double irradiance = 0.0;   // in W/m², the sum of the channels
  double form_factor = 0.0;  // of the element to all emitters, what is hidden left out
  double seen = 0.0;  // the share of the unoccluded irradiance that arrives: between 0 and 1 in
                      // half shadow
};

/// One for each element, from as many unoccluded form factors between points as there are pairs
/// with emitters, and sixteen rays. The same patches, the same numbers.
std::vector<DirectLight> direct_light(const World& world, const Tracer& tracer,
                                      const Patches& patches);

}  // namespace lantern
