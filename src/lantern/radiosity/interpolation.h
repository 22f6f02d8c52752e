// SPDX-License-Identifier: MIT
// Values of elements -> values at the smooth vertices of their patches, to be interpolated between.
// [Goral et al. 1984, Modeling the Interaction of Light Between Diffuse Surfaces, section 5]
#pragma once

#include "lantern/radiosity/patches.h"

#include <span>
#include <vector>

namespace lantern {

/// Values at the smooth vertices, for the fronts and the backs.
struct VertexValues {
  std::vector<glm::dvec3> front, back;
};

/// Values of elements, each at the centre of its patch, carried to the vertices: in each the plane
/// that fits the patches around it best, weighted by their exposed area, so that neither gradients
/// nor borders pull it to one side; then moved so that the mean over a surface is that of its
/// patches. Not negative.
VertexValues interpolate_to_vertices(const Patches& patches, std::span<const glm::dvec3> values);

}  // namespace lantern
