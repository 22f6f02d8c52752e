// SPDX-License-Identifier: MIT
// Scene and World -> the patches that radiosity is computed on, as structure of arrays. Lengths in
// metres, radiosities in W/m² per channel. Both sides of a surface reflect, so the unknowns are
// sides: element i < size() is the front of patch i, backs that light can come to follow.
#pragma once

#include "lantern/radiosity/exposure.h"
#include "lantern/radiosity/patch_mesh.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace lantern {

struct PatchOptions {
  std::size_t count = 4000;  // patches at most; surfaces of more triangles keep one for each
  std::optional<double> size =
      std::nullopt;  // instead of a count: the longest edge allowed, in metres
};

inline constexpr std::uint32_t kNoElement = std::numeric_limits<std::uint32_t>::max();

struct Patches {
  PatchMesh mesh;

  // Per patch.
  std::vector<double> area;
  std::vector<glm::dvec3> normal;  // unit, of the front
  std::vector<glm::dvec3> centre;
  std::vector<glm::dvec3> reflectance;  // mean over the patch, below 1; holes reflect nothing
  std::vector<std::uint32_t> back;      // the element of the back, or kNoElement
  // The vertices that radiosity is interpolated between: corners of patches share one where the
  // mesh's vertex, the material and the smooth normal are the same.
  std::vector<uvec3> smooth_vertices;
  std::size_t smooth_vertex_count = 0;

  // Per triangle of the world.
  LitSides lit;

  // Per element.
  std::vector<std::uint32_t> patch;
  std::vector<glm::dvec3> emission;  // radiosity that leaves by itself: π times the mean radiance
  std::vector<double> exposed;       // the share of the area that light can come to, in [0, 1]

  std::size_t size() const { return area.size(); }
  std::size_t elements() const { return patch.size(); }
  bool is_front(std::size_t element) const { return element < size(); }
  glm::dvec3 element_normal(std::size_t element) const {
    return is_front(element) ? normal[element] : -normal[patch[element]];
  }
  double exposed_area(std::size_t element) const { return area[patch[element]] * exposed[element]; }
  /// The element on that side of a patch, or kNoElement.
  std::uint32_t element_at(std::uint32_t of_patch, bool front) const {
    return front ? of_patch : back[of_patch];
  }
};

/// Throws Error with the numbers if so many patches do not fit in memory.
void require_patch_memory(std::size_t count);

/// The surfaces cut as `options` say, but for those that no light comes to. Throws Error for a
/// scene without triangles, for patches that reflect all light in some channel and for a size that
/// makes too many.
Patches make_patches(const Scene& scene, const World& world, const Tracer& tracer,
                     const PatchOptions& options);

/// The patches of a mesh of one's own, as one that was refined further; `lit` is of the world.
Patches make_patches(const Scene& scene, const World& world, const Tracer& tracer, PatchMesh mesh,
                     LitSides lit);

/// The patches as a world: triangle i is patch i, with the materials, texture coordinates and
/// colours of the surfaces, so that a tracer over it tells patches apart. It has no normals.
World patch_world(const World& world, const Patches& patches);

}  // namespace lantern
