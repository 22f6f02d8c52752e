// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/occluder_textures.h"

#include "lantern/radiosity_gl/texels.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lantern {
namespace {

constexpr std::size_t kInTexel = 4;

std::size_t texels_of(const std::vector<std::uint32_t>& list) {
  return (std::min(list.size(), OccluderTextures::kMostNeighbours) + kInTexel - 1) / kInTexel;
}

gl::Texture make_corners(const World& world, const std::vector<std::vector<std::uint32_t>>& lists) {
  constexpr int kCorners = 3;
  const TexelGrid grid(world.size());
  std::vector<Vec4> corners(kCorners * grid.texels(), Vec4(0.0f));
  std::size_t first = 0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const std::array<std::size_t, kCorners> beside = {first, texels_of(lists[t]), 0};
    for (int k = 0; k < kCorners; ++k) {
      const auto layer = static_cast<std::size_t>(k);
      corners[layer * grid.texels() + t] =
          Vec4(world.positions[world.triangles[t][k]], static_cast<float>(beside[layer]));
    }
    first += beside[1];
  }
  return make_texture(grid, corners, kCorners);
}

gl::Texture make_neighbours(const std::vector<std::vector<std::uint32_t>>& lists) {
  std::vector<Vec4> values;
  for (const std::vector<std::uint32_t>& list : lists) {
    for (std::size_t i = 0; i < texels_of(list); ++i) {
      Vec4 texel(0.0f);
      for (std::size_t k = 0; k < kInTexel && i * kInTexel + k < list.size(); ++k) {
        texel[static_cast<int>(k)] = static_cast<float>(list[i * kInTexel + k] + 1);
      }
      values.push_back(texel);
    }
  }
  const TexelGrid grid(values.size());
  values.resize(grid.texels(), Vec4(0.0f));
  return make_texture(grid, values);
}

}  // namespace

std::vector<std::vector<std::uint32_t>> neighbours_of_triangles(const World& world,
                                                                const PatchMesh& mesh) {
  struct Corner {
    std::uint32_t vertex, triangle;
    auto operator<=>(const Corner&) const = default;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.size());
  for (const PatchMesh::Face& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) corners.push_back({face.vertices[k], face.source});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<std::vector<std::uint32_t>> result(world.size());
  for (std::size_t first = 0; first < corners.size();) {
    std::size_t end = first + 1;
    while (end < corners.size() && corners[end].vertex == corners[first].vertex) ++end;
    for (std::size_t i = first; i < end; ++i) {
      for (std::size_t j = first; j < end; ++j) {
        if (i != j) result[corners[i].triangle].push_back(corners[j].triangle);
      }
    }
    first = end;
  }
  for (std::vector<std::uint32_t>& list : result) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return result;
}

OccluderTextures::OccluderTextures(const World& world, const PatchMesh& mesh)
    : OccluderTextures(world, neighbours_of_triangles(world, mesh)) {}

OccluderTextures::OccluderTextures(const World& world, const Lists& lists)
    : corners_(make_corners(world, lists)), neighbours_(make_neighbours(lists)) {}

}  // namespace lantern
