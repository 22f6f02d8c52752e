// SPDX-License-Identifier: MIT
// The triangles of a World, and those that touch them, as textures that ways are met with: an item
// buffer's pixels say which triangles to ask, and what lies between pixels is found beside these.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/radiosity/patch_mesh.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <vector>

namespace lantern {

/// Of each triangle of the world the others that it shares a vertex of the mesh with, and so, as
/// the mesh has no T-junctions, a part of an edge or a corner; in ascending order. `mesh` is the
/// world's, refined or not.
std::vector<std::vector<std::uint32_t>> neighbours_of_triangles(const World& world,
                                                                const PatchMesh& mesh);

class OccluderTextures {
 public:
  /// At most so many neighbours of a triangle are kept: all tests of a way take time.
  static constexpr std::size_t kMostNeighbours = 16;

  OccluderTextures(const World& world, const PatchMesh& mesh);

  /// In three layers the corners of each triangle; w of the first layer: the texel in neighbours()
  /// where its own begin, of the second how many texels they fill.
  const gl::Texture& corners() const { return corners_; }
  /// Four a texel: the triangle's number plus 1, or 0.
  const gl::Texture& neighbours() const { return neighbours_; }

 private:
  using Lists = std::vector<std::vector<std::uint32_t>>;
  OccluderTextures(const World& world, const Lists& lists);

  gl::Texture corners_, neighbours_;
};

}  // namespace lantern
