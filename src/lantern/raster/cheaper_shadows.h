// SPDX-License-Identifier: MIT
// Which shadows of a scene's lights take less time: a map draws every triangle once and is kept,
// volumes draw the quads of a silhouette for every sample. No GL in it.
#pragma once

#include "lantern/raster/shadow_method.h"
#include "lantern/scene/world.h"

#include <cstddef>

namespace lantern {

/// kVolumes or kMaps, for `samples` that are drawn with the shadows of the same lights, wherever on
/// the scene's surfaces these are. `casters`: those of the world's triangles that cast shadows.
ShadowMethod cheaper_shadows(const World& world, const World& casters, std::size_t samples);

}  // namespace lantern
