// SPDX-License-Identifier: MIT
// The silhouette of a part of the scene as a light sees it -> one of fewer edges, off by no more
// than is asked for. What is cut off ends volumes where there is no surface, which must not be
// seen: the part has to be convex, so that it is inside.
#pragma once

#include "lantern/raster/volume_edge.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

class SilhouetteSimplifier {
 public:
  /// Keeps a reference to the vertices.
  SilhouetteSimplifier(std::span<const Vec3> vertices, const LightPoint& light)
      : vertices_(vertices), light_(light), outgoing_(vertices.size(), 0u) {}

  /// Of the edges from number `first` on, which are one part's, leaves out vertices that two of
  /// them meet in and that are no further than `distance` off the line. The result is what that
  /// takes the shadows of away, one triangle a vertex; it holds until the next call.
  std::span<const uvec3> simplify(std::vector<VolumeEdge>& edges, std::size_t first,
                                  float distance);

 private:
  void link();
  /// The edge from there on, if it is the only one.
  const VolumeEdge* next(std::uint32_t vertex) const;
  void follow(std::size_t edge);
  bool is_along(std::size_t from, std::size_t to, float distance) const;

  std::span<const Vec3> vertices_;
  LightPoint light_;
  std::vector<std::uint32_t> outgoing_;  // edge from each vertex, if that edge begins there
  std::vector<VolumeEdge> edges_;        // of the part
  std::vector<std::uint8_t> taken_;      // into a chain
  std::vector<std::uint32_t> chain_;     // vertices that follow each other
  std::vector<uvec3> left_out_;
};

}  // namespace lantern
