// SPDX-License-Identifier: MIT
#include "lantern/bake/solution.h"

#include "lantern/scene/surface.h"

#include <cassert>

namespace lantern {

Solution::Solution(const Scene& scene, const World& world, const Patches& patches,
                   std::span<const glm::dvec3> irradiance)
    : scene_(scene),
      patches_(patches),
      surfaces_(patch_world(world, patches)),
      values_(interpolate_to_vertices(patches, irradiance)) {
  assert(irradiance.size() == patches.elements());
}

Rgb Solution::irradiance(std::uint32_t element, Vec2 uv) const {
  const auto& at = patches_.is_front(element) ? values_.front : values_.back;
  const uvec3 v = patches_.smooth_vertices[patches_.patch[element]];
  const glm::dvec2 w(uv);
  return Rgb(at[v.x] * (1.0 - w.x - w.y) + at[v.y] * w.x + at[v.z] * w.y);
}

Rgb Solution::reflected(std::uint32_t element, Vec2 uv) const {
  const std::uint32_t patch = patches_.patch[element];
  return surface_at(scene_, surfaces_, patch, uv).reflectance * irradiance(element, uv) * kInvPi;
}

Rgb Solution::emitted(std::uint32_t element, Vec2 uv) const {
  return emission_at(scene_, surfaces_, patches_.patch[element], uv, patches_.is_front(element));
}

}  // namespace lantern
