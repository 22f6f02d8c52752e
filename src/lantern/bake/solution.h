// SPDX-License-Identifier: MIT
// A radiosity solution as light to look at: irradiance of elements in W/m², interpolated between
// the vertices of each smooth surface -> what a point of a patch reflects and emits, the same from
// everywhere. Radiance in W/(m² sr).
#pragma once

#include "lantern/radiosity/interpolation.h"
#include "lantern/radiosity/patches.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <span>

namespace lantern {

class Solution {
 public:
  /// Keeps references to `scene` and `patches`; `irradiance` holds one for each element.
  Solution(const Scene& scene, const World& world, const Patches& patches,
           std::span<const glm::dvec3> irradiance);

  const Scene& scene() const { return scene_; }
  const Patches& patches() const { return patches_; }
  /// Of the patches: triangle i is patch i.
  const World& surfaces() const { return surfaces_; }
  const Material& material(std::uint32_t element) const {
    return scene_.materials[index(surfaces_.materials[patches_.patch[element]])];
  }

  /// `uv` are the barycentric weights of the patch's second and third corner, here and below.
  Rgb irradiance(std::uint32_t element, Vec2 uv) const;
  Rgb reflected(std::uint32_t element, Vec2 uv) const;
  Rgb emitted(std::uint32_t element, Vec2 uv) const;

 private:
  const Scene& scene_;
  const Patches& patches_;
  World surfaces_;
  VertexValues values_;
};

}  // namespace lantern
