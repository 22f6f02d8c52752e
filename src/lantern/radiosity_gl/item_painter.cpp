// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/item_painter.h"

#include "lantern/core/parallel.h"

#include <cassert>
#include <cmath>

namespace lantern {
namespace {

/// In the layout of shaders/hemicube.glsl. The cube's largest coordinate is 1.
std::uint32_t texel_of(const Vec3& d, int resolution) {
  const auto cell = [&](float u) {
    return static_cast<int>((u + 1.0f) * 0.5f * static_cast<float>(resolution));
  };
  int x = 0, y = 0;
  if (d.z == 1.0f) {
    x = cell(d.x);
    y = cell(d.y);
  } else {
    const bool along_x = std::abs(d.x) == 1.0f;
    const int face = (along_x ? 0 : 2) + ((along_x ? d.x : d.y) > 0.0f ? 0 : 1);
    const int half = resolution / 2;
    x = cell(along_x ? d.y : d.x);
    y = resolution + face * half + static_cast<int>(d.z * static_cast<float>(half));
  }
  return static_cast<std::uint32_t>(y * resolution + x);
}

/// Where the line meets the plane of the triangle, as weights of its second and third vertex.
Vec2 place_in(const World& world, std::uint32_t triangle, const Vec3& origin,
              const Vec3& direction) {
  const uvec3 v = world.triangles[triangle];
  const glm::dvec3 a(world.positions[v.x]), b = glm::dvec3(world.positions[v.y]) - a,
                                            c = glm::dvec3(world.positions[v.z]) - a;
  const glm::dvec3 from = glm::dvec3(origin) - a, way(direction);
  const glm::dvec3 across = glm::cross(way, c), beside = glm::cross(from, b);
  const double scale = glm::dot(b, across);
  const glm::dvec2 uv(glm::dot(from, across) / scale, glm::dot(way, beside) / scale);
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return Vec2(1.0f / 3.0f);  // seen edge on
  return Vec2(glm::clamp(uv, 0.0, 1.0));
}

}  // namespace

ItemPainter::ItemPainter(const World& world, int resolution)
    : world_(world),
      buffer_(world, std::vector<bool>(world.size(), true), resolution, gl::ShaderFiles()),
      items_({&buffer_.items()}) {
  const Hemicube cube(resolution);
  for (std::size_t i = 0; i < cube.size(); ++i) {
    texel_of_pixel_.push_back(texel_of(cube.direction(i), resolution));
  }
}

void ItemPainter::draw(const Hemicube& cube, const HemicubeView& view, std::span<Hit> hits) {
  assert(cube.size() == texel_of_pixel_.size() && hits.size() == cube.size());
  const Frame& frame = view.frame;
  buffer_.draw({view.origin, glm::transpose(Mat3(frame.tangent, frame.bitangent, frame.normal)),
                view.shift});
  const std::vector<std::uint32_t> items = items_.read<std::uint32_t>();
  constexpr std::size_t kGrain = 1024;
  parallel_for(hits.size(), kGrain, [&](std::size_t i) {
    const std::uint32_t item = items[texel_of_pixel_[i]];
    hits[i] = Hit{};
    if (item == 0) return;
    hits[i].distance = 0.0f;
    hits[i].triangle = item - 1;
    hits[i].uv = place_in(world_, item - 1, view.origin, cube.direction(view, i));
  });
}

}  // namespace lantern
