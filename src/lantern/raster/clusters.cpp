// SPDX-License-Identifier: MIT
#include "lantern/raster/clusters.h"

#include <algorithm>
#include <utility>

namespace lantern {
namespace {

constexpr std::uint32_t kTriangles = 16;  // of a cluster, at most

/// The lowest ten bits, two zeros between each and the next.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

Vec3 centre_of(const World& world, std::uint32_t triangle) {
  const uvec3 v = world.triangles[triangle];
  return (world.positions[v.x] + world.positions[v.y] + world.positions[v.z]) * (1.0f / 3.0f);
}

/// Along a curve that fills the scene's box.
std::uint32_t place_on_curve(const Vec3& p, const Bounds& box) {
  constexpr float kSteps = 1023.0f;
  const float side = std::max(2.0f * box.radius(), std::numeric_limits<float>::min());
  const Vec3 step = glm::clamp((p - box.low) * (kSteps / side), 0.0f, kSteps);
  return spread(static_cast<std::uint32_t>(step.x)) |
         spread(static_cast<std::uint32_t>(step.y)) << 1 |
         spread(static_cast<std::uint32_t>(step.z)) << 2;
}

}  // namespace

std::vector<Cluster> make_clusters(const World& world, std::span<std::uint32_t> triangles,
                                   std::uint32_t before) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  places.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    places.emplace_back(place_on_curve(centre_of(world, t), world.bounds), t);
  }
  std::sort(places.begin(), places.end());
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < places.size(); ++i) triangles[i] = places[i].second;
  for (std::size_t first = 0; first < triangles.size(); first += kTriangles) {
    const auto run =
        triangles.subspan(first, std::min<std::size_t>(kTriangles, triangles.size() - first));
    Bounds bounds;
    for (const std::uint32_t t : run) {
      for (int corner = 0; corner < 3; ++corner) {
        bounds.add(world.positions[world.triangles[t][corner]]);
      }
    }
    clusters.push_back({before + static_cast<std::uint32_t>(first),
                        static_cast<std::uint32_t>(run.size()), bounds.centre(), bounds.radius()});
  }
  return clusters;
}

bool may_lie_inside(const Cluster& cluster, const Vec3& origin, std::span<const Vec4> planes) {
  const Vec3 centre = cluster.centre - origin;
  return std::all_of(planes.begin(), planes.end(), [&](const Vec4& plane) {
    return glm::dot(Vec3(plane), centre) + plane.w >= -cluster.radius * glm::length(Vec3(plane));
  });
}

}  // namespace lantern
