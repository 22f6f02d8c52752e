// SPDX-License-Identifier: MIT
// World -> a conforming triangle mesh over all its surfaces, and its refinement by bisecting
// longest edges with closure: no vertex ever lies inside another triangle's edge that did not
// before, no angle falls below half the least of the input. [Rivara 1984, Algorithms for Refining
// Triangular Grids Suitable for Adaptive and Multigrid Techniques]
#pragma once

#include "lantern/scene/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// Triangles that share vertices wherever their positions are equal, whatever their material.
struct PatchMesh {
  struct Face {
    uvec3 vertices;                    // counter-clockwise seen from the front
    std::uint32_t source;              // the triangle of the world that it is a part of
    std::array<glm::dvec2, 3> places;  // of its corners there: weights of second and third vertex
  };

  std::vector<glm::dvec3> positions;
  std::vector<Face> faces;

  std::size_t size() const { return faces.size(); }
  glm::dvec3 corner(std::size_t face, int i) const { return positions[faces[face].vertices[i]]; }
  /// cross(b - a, c - a): twice the area along the front's normal.
  glm::dvec3 area_vector(std::size_t face) const;
  double longest_edge(std::size_t face) const;
};

/// One face for each triangle of the world.
PatchMesh make_patch_mesh(const World& world);

/// Bisects the marked faces, and as many others as the mesh needs to stay conforming. Returns for
/// each face the one that it was or is a part of.
std::vector<std::uint32_t> bisect(PatchMesh& mesh, const std::vector<bool>& marked);

/// Triangles of the world whose faces are left as they are, save for what closure asks for; empty:
/// none.
using LeftAlone = std::vector<bool>;

/// Until no edge is longer than `size` (above zero, metres). Throws Error once there are more faces
/// than `most`.
void refine_to_size(PatchMesh& mesh, double size, std::size_t most, const LeftAlone& alone = {});

/// Longest edges first, until one more bisection would make more than `count` faces.
void refine_to_count(PatchMesh& mesh, std::size_t count, const LeftAlone& alone = {});

/// Bisects the faces of the highest scores (one for each face), and what they fall into, until one
/// more would make more than `count` faces. `decay` is the score of a half over that of its whole.
void refine_highest(PatchMesh& mesh, std::span<const double> scores, double decay,
                    std::size_t count);

}  // namespace lantern
