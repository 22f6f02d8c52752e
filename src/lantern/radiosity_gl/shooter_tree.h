// SPDX-License-Identifier: MIT
// Elements of patches -> a hierarchy of clusters that each lie in one plane, and the choice of
// those to shoot from: coarse where little flux leaves or a cluster is small, fine where much does.
// Texels are elements in the order of the hierarchy, so that a cluster is a run of them.
#pragma once

#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// A run of texels.
struct Cluster {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  glm::dvec3 centre{0.0};   // of its box, in metres
  double radius = 0.0;      // about the centre, of all corners
  double area = 0.0;        // exposed, m²
  std::uint32_t shots = 1;  // that its flux should be shot in, each from another point
};

/// What is left to a single hemicube, for the errors of a shot are those of one point standing for
/// the whole cluster.
struct ShotLimits {
  double share = 1.0 / 256.0;  // of the emitted flux
  double spread = 1e-5;        // share times the square of the radius, in scene radii
  double radius = 0.25;        // in scene radii
  std::uint32_t count = 64;    // elements, which receivers nearby sum over
};

class ShooterTree {
 public:
  explicit ShooterTree(const Patches& patches);

  /// Which element a texel is.
  const std::vector<std::uint32_t>& element_of_texel() const { return element_of_texel_; }

  /// The clusters to shoot from, those with most flux first: the coarsest within `limits`, of them
  /// all that have at least 1/16 of the flux of the first. An element beyond the limits takes
  /// several shots. `flux` is in W, one for each texel, all channels together; `emitted` likewise;
  /// `scene_radius` in metres.
  std::vector<Cluster> choose(std::span<const double> flux, double emitted, double scene_radius,
                              const ShotLimits& limits) const;

 private:
  struct Node : Cluster {
    std::uint32_t child = 0;  // the first of two that follow each other; 0: none
  };

  void split(const Patches& patches, std::uint32_t node);

  std::vector<std::uint32_t> element_of_texel_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> roots_;
};

}  // namespace lantern
