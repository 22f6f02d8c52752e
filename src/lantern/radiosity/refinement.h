// SPDX-License-Identifier: MIT
// Where patches should be smaller: where the solution bends between them, at shadow edges above
// all. [Cohen, Greenberg, Immel & Brock 1986, An Efficient Radiosity Approach for Realistic Image
// Synthesis: adaptive subdivision]
#pragma once

#include "lantern/radiosity/patches.h"

#include <span>
#include <vector>

namespace lantern {

/// What becomes of a patch's variation when it is halved: half the area, times an extent that falls
/// by the square root of two.
inline constexpr double kVariationOfHalf = 0.35355339059327373;

/// For each patch the flux in W by which what it reflects varies over it: the largest difference of
/// the irradiance at its vertices from its own, times its reflectance and exposed area; both sides
/// and all channels together. `irradiance` has one value for each element.
std::vector<double> variations(const Patches& patches, std::span<const glm::dvec3> irradiance);

}  // namespace lantern
