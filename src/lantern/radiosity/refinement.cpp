// SPDX-License-Identifier: MIT
#include "lantern/radiosity/refinement.h"

#include "lantern/radiosity/interpolation.h"

namespace lantern {

std::vector<double> variations(const Patches& patches, std::span<const glm::dvec3> irradiance) {
  const VertexValues at = interpolate_to_vertices(patches, irradiance);
  std::vector<double> result(patches.size(), 0.0);
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    const std::uint32_t patch = patches.patch[e];
    const std::vector<glm::dvec3>& values = patches.is_front(e) ? at.front : at.back;
    const uvec3 v = patches.smooth_vertices[patch];
    glm::dvec3 most(0.0);
    for (int k = 0; k < 3; ++k) most = glm::max(most, glm::abs(irradiance[e] - values[v[k]]));
    most *= patches.reflectance[patch];
    result[patch] += patches.exposed_area(e) * (most.r + most.g + most.b);
  }
  return result;
}

}  // namespace lantern
