// SPDX-License-Identifier: MIT
// A place on a triangle of the world -> the patch that it lies on, by a grid over each triangle. So
// rays meet the few triangles of the world, however many patches these are cut into.
#pragma once

#include "lantern/radiosity/patch_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

class PatchLocator {
 public:
  /// `triangles` of the world, all of which the mesh covers.
  PatchLocator(const PatchMesh& mesh, std::size_t triangles);

  /// `uv` are the weights of the second and third vertex, as hits have them. On a border, to the
  /// rounding of float, either patch.
  std::uint32_t at(std::uint32_t triangle, Vec2 uv) const;

 private:
  /// Weights of a face's second and third corner are linear in those of its source.
  struct Face {
    float u[3], v[3];  // constant, per u, per v
    std::uint32_t patch;
  };
  /// How far inside a face the place is: the least of its three weights.
  static float depth(const Face& face, Vec2 uv);

  struct Grid {
    std::uint32_t first = 0;  // its first cell
    std::uint32_t size = 0;   // cells along an edge; of one cell each
  };
  std::vector<Grid> grids_;           // per triangle of the world
  std::vector<std::uint32_t> cells_;  // where in `faces_` each cell's begin; one more at the end
  std::vector<Face> faces_;
};

}  // namespace lantern
