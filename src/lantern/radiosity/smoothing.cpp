// SPDX-License-Identifier: MIT
#include "lantern/radiosity/smoothing.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

namespace lantern {
namespace {

/// Cosine of about a degree: normals that differ less stand for one smooth surface.
constexpr double kSameNormal = 0.99985;

/// The smooth normal at a corner of a face; the face's own where the surface has none.
glm::dvec3 normal_at(const World& world, const PatchMesh::Face& face, int corner) {
  const glm::dvec3 own = glm::normalize(glm::dvec3(world.area_vector(face.source)));
  if (world.normals.empty()) return own;
  const uvec3 v = world.triangles[face.source];
  const glm::dvec2 w = face.places[static_cast<std::size_t>(corner)];
  const glm::dvec3 n = glm::dvec3(world.normals[v.x]) * (1.0 - w.x - w.y) +
                       glm::dvec3(world.normals[v.y]) * w.x + glm::dvec3(world.normals[v.z]) * w.y;
  const double length = glm::length(n);
  // Shorter than this the vertices disagree so much that their mean says nothing.
  constexpr double kShortest = 1e-3;
  if (length <= kShortest) return own;
  return glm::dot(n, own) < 0.0 ? -n / length : n / length;
}

/// A side of a face: its edge as a pair of vertices in order, and where it comes from.
struct Side {
  std::uint32_t low, high;  // vertices
  std::uint32_t face;
  int at_low, at_high;  // the face's corners there
};

}  // namespace

SmoothVertices smooth_vertices(const World& world, const PatchMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.size());
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const uvec3 v = mesh.faces[f].vertices;
      sides.push_back(v[k] < v[next] ? Side{v[k], v[next], f, k, next}
                                     : Side{v[next], v[k], f, next, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.face) < std::tuple(b.low, b.high, b.face);
  });

  // Corners that meet over an edge of one smooth surface become one vertex.
  std::vector<std::uint32_t> parent(3 * mesh.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  const auto corner = [](const Side& s, int k) {
    return 3 * s.face + static_cast<std::uint32_t>(k);
  };
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low &&
           sides[end].high == sides[first].high) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        const Side &a = sides[i], &b = sides[j];
        const PatchMesh::Face &fa = mesh.faces[a.face], &fb = mesh.faces[b.face];
        const auto same_normal = [&](int at_a, int at_b) {
          return glm::dot(normal_at(world, fa, at_a), normal_at(world, fb, at_b)) > kSameNormal;
        };
        const bool smooth = world.materials[fa.source] == world.materials[fb.source] &&
                            same_normal(a.at_low, b.at_low) && same_normal(a.at_high, b.at_high);
        if (!smooth) continue;
        join(corner(a, a.at_low), corner(b, b.at_low));
        join(corner(a, a.at_high), corner(b, b.at_high));
      }
    }
    first = end;
  }

  SmoothVertices result;
  result.of_corner.resize(mesh.size());
  std::vector<std::uint32_t> number(parent.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    const std::uint32_t root = find(i);  // never above i
    if (root == i) number[i] = static_cast<std::uint32_t>(result.count++);
    result.of_corner[i / 3][static_cast<int>(i % 3)] = number[root];
  }
  return result;
}

}  // namespace lantern
