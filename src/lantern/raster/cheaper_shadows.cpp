// SPDX-License-Identifier: MIT
#include "lantern/raster/cheaper_shadows.h"

#include "lantern/raster/edge_list.h"
#include "lantern/sampling/distribution.h"
#include "lantern/sampling/halton.h"
#include "lantern/trace/tracer.h"

#include <algorithm>
#include <vector>

namespace lantern {
namespace {

// Costs in quads of volumes, on Mesa at 640 x 480: among 64 balls and in sibenik.mesh a quad takes
// 0.9 us, a triangle of a map 0.45 and 0.9, and a standing map 0.5 ms, where one of sixteen pixels
// asks it.
constexpr double kDrawingOfTriangle = 0.75, kAskingOfMap = 600.0;

/// Quads of the volumes of lights that are spread over the surfaces, on average.
double mean_quads(const World& world, const EdgeList& list) {
  std::vector<double> areas;
  for (std::uint32_t t = 0; t < world.size(); ++t) areas.push_back(world.area(t));
  const Distribution by_area(areas);
  constexpr std::uint64_t kLights = 16;
  std::size_t quads = 0;
  for (std::uint64_t i = 0; i < kLights; ++i) {
    const auto choice = by_area.choose(static_cast<float>(radical_inverse(2, i)));
    const auto triangle = static_cast<std::uint32_t>(choice.index);
    const uvec3 v = world.triangles[triangle];
    const Vec3 middle = (world.positions[v.x] + world.positions[v.y] + world.positions[v.z]) / 3.0f;
    const Vec3 normal = glm::normalize(world.area_vector(triangle));
    const Vec3 light = off_surface(middle, normal, world.coordinate_scale());
    const std::vector<Vec4> front = {Vec4(normal, -glm::dot(normal, light))};
    quads += list.volumes(Vec4(light, 1.0f), light, VolumeCount::kHalved, front).edges.size();
  }
  return static_cast<double>(quads) / static_cast<double>(kLights);
}

}  // namespace

ShadowMethod cheaper_shadows(const World& world, const World& casters, std::size_t samples) {
  const auto triangles = static_cast<double>(casters.size());
  // A triangle by itself has three quads.
  if (3.0 * triangles < kAskingOfMap) return ShadowMethod::kVolumes;
  const double quads = mean_quads(world, EdgeList(casters, find_walls(world)));
  const bool maps_are =
      static_cast<double>(samples) * (quads - kAskingOfMap) > kDrawingOfTriangle * triangles;
  return maps_are ? ShadowMethod::kMaps : ShadowMethod::kVolumes;
}

}  // namespace lantern
