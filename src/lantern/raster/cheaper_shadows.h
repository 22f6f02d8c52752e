// SPDX-License-Identifier: MIT
// Which shadows of a scene's lights take less time: a map draws every triangle once and is kept,
// volumes draw the quads of a silhouette for every sample. No GL in it.
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/shadow_method.h"
#include "lantern/scene/world.h"

#include <cstddef>

namespace lantern {

/// kVolumes or kMaps, for `samples` that are drawn with the shadows of these lights, or of others
/// like them. `casters`: those triangles that cast shadows.
ShadowMethod cheaper_shadows(const World& casters, const VirtualLights& lights,
                             std::size_t samples);

}  // namespace lantern
