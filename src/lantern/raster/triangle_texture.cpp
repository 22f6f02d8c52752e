// SPDX-License-Identifier: MIT
#include "lantern/raster/triangle_texture.h"

#include "lantern/scene/surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace lantern {
namespace {

/// Of each triangle and edge (from its corner of this number to the next) a triangle without
/// holes that shares it, by its number and 1; 0 where there is none.
std::vector<std::array<std::uint32_t, 3>> neighbours(const Scene& scene, const World& world) {
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
  std::vector<std::array<std::uint32_t, 3>> result(world.size());
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].edge == sides[first].edge) ++end;
    for (std::size_t i = first; i < end; ++i) {
      const Side& next = sides[i + 1 < end ? i + 1 : first];
      if (next.triangle == sides[i].triangle) continue;
      result[sides[i].triangle][static_cast<std::size_t>(sides[i].corner)] = next.triangle + 1;
    }
    first = end;
  }
  return result;
}

}  // namespace

gl::Texture triangle_texture(const Scene& scene, const World& world) {
  const std::vector<std::array<std::uint32_t, 3>> beyond = neighbours(scene, world);
  const std::size_t texels = 3 * world.size();
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(texels)));
  const std::size_t width = std::bit_ceil(root + 1);
  const std::size_t height = (texels + width - 1) / width;
  std::vector<float> rgba;
  rgba.reserve(4 * width * height);
  // Floats count no further.
  constexpr std::uint32_t kCounted = 1u << 24;
  for (std::size_t t = 0; t < world.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = world.positions[world.triangles[t][i]];
      const std::uint32_t next = beyond[t][static_cast<std::size_t>(i)];
      rgba.insert(rgba.end(), {p.x, p.y, p.z, next < kCounted ? static_cast<float>(next) : 0.0f});
    }
  }
  rgba.resize(4 * width * height);
  gl::Texture texture(gl::Format::kRgba32f, static_cast<int>(width), static_cast<int>(height));
  texture.write<float>(rgba);
  return texture;
}

}  // namespace lantern
