// SPDX-License-Identifier: MIT
// The triangles of a World as a texture that shaders meet rays with: see shaders/shadow_maps.glsl.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

namespace lantern {

/// Three texels for each triangle, row by row: a corner, and the number of a triangle without holes
/// beyond the edge from it to the next and 1, or 0. Throws Error for more than a texture holds.
gl::Texture triangle_texture(const Scene& scene, const World& world);

}  // namespace lantern
