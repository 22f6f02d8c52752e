// SPDX-License-Identifier: MIT
// The triangles of a World in runs of neighbours, so that what a view cannot see is left out run by
// run.
#pragma once

#include "lantern/scene/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// A run of an order of triangles and the sphere around it.
struct Cluster {
  std::uint32_t first = 0, count = 0;
  Vec3 centre{0.0f};
  float radius = 0.0f;
};

/// Brings the triangles into an order in which neighbours follow each other [Morton 1966] and cuts
/// that into clusters, of a longer order in which `first` others come before.
std::vector<Cluster> make_clusters(const World& world, std::span<std::uint32_t> triangles,
                                   std::uint32_t first = 0);

/// Whether some of the cluster may lie on the positive side of all planes, its place taken from
/// `origin`.
bool may_lie_inside(const Cluster& cluster, const Vec3& origin, std::span<const Vec4> planes);

}  // namespace lantern
