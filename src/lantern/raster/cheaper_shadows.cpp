// SPDX-License-Identifier: MIT
#include "lantern/raster/cheaper_shadows.h"

#include "lantern/raster/edge_list.h"
#include "lantern/raster/map_faces.h"
#include "lantern/raster/raster_lights.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace lantern {
namespace {

// Costs in quads of volumes, on Mesa at 640 x 480: among 64 balls and in sibenik.mesh a quad takes
// 0.9 us, a triangle of a map 0.45 and 0.9, and a standing map 0.5 ms, where one of sixteen pixels
// asks it.
constexpr double kDrawingOfTriangle = 0.75, kAskingOfMap = 600.0;

/// Quads of the volumes of some of the lights, on average; wherever the eye is.
double mean_quads(const EdgeList& list, std::span<const LightGroup> groups, const Vec3& eye) {
  constexpr std::size_t kLights = 16;
  std::vector<std::pair<const LightGroup*, std::size_t>> all;
  for (const LightGroup& group : groups) {
    for (std::size_t i = 0; i < group.points.size(); ++i) all.emplace_back(&group, i);
  }
  const std::size_t some = std::min(kLights, all.size());
  std::size_t quads = 0;
  for (std::size_t k = 0; k < some; ++k) {
    const auto [group, i] = all[k * all.size() / some];
    std::vector<Vec4> region;
    if (!group->fronts.empty()) region.push_back(group->fronts[i]);
    quads += list.volumes(group->points[i], eye, VolumeCount::kHalved, region).edges.size();
  }
  return static_cast<double>(quads) / static_cast<double>(some);
}

/// The share of the lights whose maps are not drawn anew for each sample.
double kept_share(std::span<const LightGroup> groups, std::size_t casters) {
  double bytes = 0.0;
  for (const LightGroup& group : groups) {
    const double side = map_size(group.formula, octahedron_size(casters));
    bytes += static_cast<double>(group.points.size() * kMapTexelBytes) * side * side;
  }
  return std::min(1.0, static_cast<double>(kMapBytes) / bytes);
}

}  // namespace

ShadowMethod cheaper_shadows(const World& casters, const VirtualLights& lights,
                             std::size_t samples) {
  const auto triangles = static_cast<double>(casters.size());
  const std::vector<LightGroup> groups = group_lights(lights, {}, casters.coordinate_scale());
  // A triangle by itself has three quads.
  if (groups.empty() || 3.0 * triangles < kAskingOfMap) return ShadowMethod::kVolumes;
  const double quads =
      mean_quads(EdgeList(casters, find_walls(casters)), groups, casters.bounds.centre());
  const auto n = static_cast<double>(samples);
  const double kept = kept_share(groups, casters.size());
  const double by_volumes = n * quads;
  const double by_maps =
      (kept + n * (1.0 - kept)) * kDrawingOfTriangle * triangles + n * kAskingOfMap;
  return by_maps < by_volumes ? ShadowMethod::kMaps : ShadowMethod::kVolumes;
}

}  // namespace lantern
