// SPDX-License-Identifier: MIT
// Irradiance that point, spot and directional lights and the sky bring to elements directly, in
// W/m²: what radiosity takes as given, since it comes from no patch.
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/radiosity/patches.h"

#include <vector>

namespace lantern {

/// One for each element, the mean over points of its exposed part. Rays decide what is seen.
/// Elements not reached before `stop` is set stay 0.
std::vector<glm::dvec3> external_irradiance(const Scene& scene, const World& world,
                                            const Tracer& tracer, const Patches& patches,
                                            const StopFlag& stop);

}  // namespace lantern
