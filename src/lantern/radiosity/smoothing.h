// SPDX-License-Identifier: MIT
// A mesh of patches -> the vertices that values are interpolated between. Where material or smooth
// normal jump each side has vertices of its own, and the light its discontinuity.
#pragma once

#include "lantern/radiosity/patch_mesh.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <vector>

namespace lantern {

struct SmoothVertices {
  std::vector<uvec3> of_corner;  // per face
  std::size_t count = 0;
};

SmoothVertices smooth_vertices(const World& world, const PatchMesh& mesh);

}  // namespace lantern
