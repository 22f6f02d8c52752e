// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/shooter_tree.h"

#include "lantern/radiosity/element_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lantern {
namespace {

/// How many parts of a cluster, each with its share of the flux and of the area, are within the
/// limits; `radius` is in scene radii.
double beyond(const ShotLimits& limits, double share, double radius) {
  const double square = radius * radius;
  return std::max({share / limits.share, std::sqrt(share * square / limits.spread),
                   square / (limits.radius * limits.radius)});
}

std::uint32_t shots_for(double parts) {
  return static_cast<std::uint32_t>(
      std::ceil(std::clamp(parts, 1.0, static_cast<double>(ElementPoints::kPoints))));
}

}  // namespace

ShooterTree::ShooterTree(const Patches& patches) : element_of_texel_(patches.elements()) {
  std::iota(element_of_texel_.begin(), element_of_texel_.end(), 0u);
  // A side of a triangle of the world is one plane.
  const auto plane = [&](std::uint32_t e) {
    return std::tuple(patches.mesh.faces[patches.patch[e]].source, !patches.is_front(e), e);
  };
  std::sort(element_of_texel_.begin(), element_of_texel_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return plane(a) < plane(b); });
  const auto size = static_cast<std::uint32_t>(element_of_texel_.size());
  for (std::uint32_t first = 0; first < size;) {
    const auto [source, back, element] = plane(element_of_texel_[first]);
    std::uint32_t end = first;
    while (end < size && std::get<0>(plane(element_of_texel_[end])) == source &&
           std::get<1>(plane(element_of_texel_[end])) == back) {
      ++end;
    }
    roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    Node root;
    root.first = first;
    root.count = end - first;
    nodes_.push_back(root);
    first = end;
  }
  // Nodes that splitting appends are met later in this loop.
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) split(patches, n);
}

void ShooterTree::split(const Patches& patches, std::uint32_t node) {
  Node& parent = nodes_[node];
  const auto begin = element_of_texel_.begin() + parent.first;
  const auto end = begin + parent.count;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (auto e = begin; e != end; ++e) {
    parent.area += patches.exposed_area(*e);
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, patches.mesh.corner(patches.patch[*e], k));
      high = glm::max(high, patches.mesh.corner(patches.patch[*e], k));
    }
  }
  parent.centre = 0.5 * (low + high);
  parent.radius = 0.5 * glm::length(high - low);
  if (parent.count == 1) return;
  const glm::dvec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = begin + parent.count / 2;
  std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(patches.centre[patches.patch[a]][axis], a) <
           std::pair(patches.centre[patches.patch[b]][axis], b);
  });
  Node left, right;
  left.first = parent.first;
  left.count = static_cast<std::uint32_t>(middle - begin);
  right.first = left.first + left.count;
  right.count = parent.count - left.count;
  parent.child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(left);
  nodes_.push_back(right);
}

std::vector<Cluster> ShooterTree::choose(std::span<const double> flux, double emitted,
                                         double scene_radius, const ShotLimits& limits) const {
  std::vector<double> below(flux.size() + 1, 0.0);
  std::partial_sum(flux.begin(), flux.end(), below.begin() + 1);
  struct Candidate {
    double flux;
    std::uint32_t node;
    std::uint32_t shots;
  };
  std::vector<Candidate> candidates;
  std::vector<std::uint32_t> open(roots_.rbegin(), roots_.rend());
  while (!open.empty()) {
    const std::uint32_t n = open.back();
    open.pop_back();
    const Node& node = nodes_[n];
    const double here = below[node.first + node.count] - below[node.first];
    if (here <= 0.0) continue;
    const double share = here / emitted, radius = node.radius / scene_radius;
    const double excess = beyond(limits, share, radius);
    if ((excess <= 1.0 && node.count <= limits.count) || node.child == 0) {
      candidates.push_back({here, n, shots_for(excess)});
    } else {
      open.push_back(node.child + 1);
      open.push_back(node.child);
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.flux > b.flux || (a.flux == b.flux && a.node < b.node);
  });
  constexpr double kLeastOfFirst = 1.0 / 16.0;
  std::vector<Cluster> chosen;
  for (const Candidate& candidate : candidates) {
    if (candidate.flux < kLeastOfFirst * candidates.front().flux) break;
    chosen.push_back(nodes_[candidate.node]);
    chosen.back().shots = candidate.shots;
  }
  return chosen;
}

}  // namespace lantern
