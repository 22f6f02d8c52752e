// SPDX-License-Identifier: MIT
#include "lantern/raster/neighbours.h"

#include "lantern/scene/surface.h"

#include <algorithm>
#include <tuple>

namespace lantern {

std::vector<std::array<std::uint32_t, 3>> find_neighbours(const Scene& scene, const World& world) {
  struct Side {
    std::array<float, 6> edge;  // its ends, the smaller first
    std::uint32_t triangle;
    int corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    if (has_holes(scene.materials[index(world.materials[t])])) continue;
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = world.positions[world.triangles[t][i]];
      const Vec3 b = world.positions[world.triangles[t][(i + 1) % 3]];
      const std::array<float, 3> from = {a.x, a.y, a.z}, to = {b.x, b.y, b.z};
      const auto [low, high] = std::minmax(from, to);
      sides.push_back({{low[0], low[1], low[2], high[0], high[1], high[2]}, t, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.edge, a.triangle, a.corner) < std::tie(b.edge, b.triangle, b.corner);
  });
  std::vector<std::array<std::uint32_t, 3>> result(world.size(),
                                                   {kNoTriangle, kNoTriangle, kNoTriangle});
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].edge == sides[first].edge) ++end;
    for (std::size_t i = first; i < end; ++i) {
      const Side& next = sides[i + 1 < end ? i + 1 : first];
      if (next.triangle == sides[i].triangle) continue;
      result[sides[i].triangle][static_cast<std::size_t>(sides[i].corner)] = next.triangle;
    }
    first = end;
  }
  return result;
}

}  // namespace lantern
