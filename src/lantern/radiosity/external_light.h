// SPDX-License-Identifier: MIT
// Irradiance that point, spot and directional lights and the sky bring to elements directly, in
// W/m²: what radiosity takes as given, since it comes from no patch.
#pragma once

#include "lantern/radiosity/patches.h"

#include <vector>

namespace lantern {

/// One for each element, the mean over points of its exposed part. Rays decide what is seen.
std::vector<glm::dvec3> external_irradiance(const Scene& scene, const World& world,
                                            const Tracer& tracer, const Patches& patches);

}  // namespace lantern
