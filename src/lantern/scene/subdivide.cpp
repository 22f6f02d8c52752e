// SPDX-License-Identifier: MIT
#include "lantern/scene/subdivide.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>

namespace lantern {
namespace {

/// A vertex of the grid over a triangle: how many of the pieces along an edge it is away from each
/// corner's opposite side. They sum up to `pieces`.
using Weights = std::array<std::uint32_t, 3>;

/// The triangle's corners in an order that does not depend on the triangle: neighbours add up the
/// same numbers in the same order and meet in the same point.
std::array<int, 3> order_of_corners(const World& world, const uvec3& triangle) {
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Vec3 p = world.positions[triangle[a]], q = world.positions[triangle[b]];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  });
  return order;
}

template <typename T>
T interpolated(const std::vector<T>& values, const uvec3& triangle, const Weights& weights,
               const std::array<int, 3>& order) {
  T sum(0.0f);
  float all = 0.0f;
  for (const int corner : order) {
    const float weight = static_cast<float>(weights[static_cast<std::size_t>(corner)]);
    if (weight == 0.0f) continue;
    sum += weight * values[triangle[corner]];
    all += weight;
  }
  return sum / all;
}

}  // namespace

World subdivided(const World& world, std::uint32_t pieces) {
  assert(pieces >= 1);
  World finer;
  finer.bounds = world.bounds;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const uvec3 triangle = world.triangles[t];
    const std::array<int, 3> order = order_of_corners(world, triangle);
    const auto first = static_cast<std::uint32_t>(finer.positions.size());
    // Row r holds pieces - r + 1 vertices.
    const auto vertex = [&](std::uint32_t row, std::uint32_t column) {
      return first + row * (pieces + 1) - row * (row - 1) / 2 + column;
    };
    for (std::uint32_t row = 0; row <= pieces; ++row) {
      for (std::uint32_t column = 0; row + column <= pieces; ++column) {
        const Weights weights = {pieces - row - column, column, row};
        const auto add = [&](auto& to, const auto& from) {
          if (!from.empty()) to.push_back(interpolated(from, triangle, weights, order));
        };
        add(finer.positions, world.positions);
        add(finer.normals, world.normals);
        add(finer.texcoords, world.texcoords);
        add(finer.colours, world.colours);
        if (row + column == pieces) continue;
        finer.triangles.emplace_back(vertex(row, column), vertex(row, column + 1),
                                     vertex(row + 1, column));
        if (row + column + 1 == pieces) continue;
        finer.triangles.emplace_back(vertex(row, column + 1), vertex(row + 1, column + 1),
                                     vertex(row + 1, column));
      }
    }
    finer.materials.resize(finer.triangles.size(), world.materials[t]);
  }
  return finer;
}

}  // namespace lantern
