// SPDX-License-Identifier: MIT
#include "lantern/raster/triangle_texture.h"

#include "lantern/scene/surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// A size for so many texels, row by row: widths are powers of two.
std::pair<int, int> size_for(std::size_t texels) {
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(texels)));
  const std::size_t width = std::bit_ceil(root + 1);
  const std::size_t height = std::max<std::size_t>((texels + width - 1) / width, 1);
  return {static_cast<int>(width), static_cast<int>(height)};
}

/// A texture of these channels, four for each texel.
template <typename T>
gl::Texture texture_of(gl::Format format, std::vector<T> channels) {
  const auto [width, height] = size_for(channels.size() / 4);
  channels.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  gl::Texture texture(format, width, height);
  texture.write<T>(channels);
  return texture;
}

gl::Texture corner_texture(const Scene& scene, const World& world, const ConvexPatches& patches,
                           std::span<const std::array<std::uint32_t, 3>> neighbours) {
  std::vector<std::uint32_t> numbers(world.size());
  for (std::uint32_t i = 0; i < world.size(); ++i) numbers[patches.order[i]] = i + 1;
  std::vector<float> channels;
  channels.reserve(12 * world.size());
  // Floats count no further.
  constexpr std::uint32_t kCounted = 1u << 24;
  for (const std::uint32_t t : patches.order) {
    const std::optional<float> coverage = even_coverage(scene.materials[index(world.materials[t])]);
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = world.positions[world.triangles[t][i]];
      const std::uint32_t beyond = neighbours[t][static_cast<std::size_t>(i)];
      const std::uint32_t next = beyond == kNoTriangle ? 0 : numbers[beyond];
      const float number = next < kCounted ? static_cast<float>(next) : 0.0f;
      channels.insert(channels.end(), {p.x, p.y, p.z, coverage.value_or(number)});
    }
  }
  return texture_of(gl::Format::kRgba32f, std::move(channels));
}

gl::Texture owner_texture(const World& world, const ConvexPatches& patches) {
  std::vector<std::uint32_t> channels(4 * world.size());
  for (std::uint32_t i = 0; i < world.size(); ++i) {
    const std::uint32_t t = patches.order[i];
    const ConvexPatches::Patch& patch = patches.patches[patches.patch_of[t]];
    const std::array<std::uint32_t, 4> texel = {i, patch.first, patch.count, patches.sides[t]};
    std::copy(texel.begin(), texel.end(), channels.begin() + 4 * static_cast<std::ptrdiff_t>(t));
  }
  return texture_of(gl::Format::kRgba32ui, std::move(channels));
}

}  // namespace

TriangleTextures::TriangleTextures(const Scene& scene, const World& world)
    : TriangleTextures(scene, world, find_neighbours(scene, world)) {}

TriangleTextures::TriangleTextures(const Scene& scene, const World& world,
                                   std::span<const std::array<std::uint32_t, 3>> neighbours)
    : patches(find_convex_patches(world, neighbours)),
      corners(corner_texture(scene, world, patches, neighbours)),
      owners(owner_texture(world, patches)) {}

}  // namespace lantern
