// SPDX-License-Identifier: MIT
// Which of many lights to ask from a given point: a binary tree over them whose branches are taken
// in proportion to what each could send there at most, by its strength, distance and directions.
// [Conty Estevez & Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting]
#pragma once

#include "lantern/core/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// A light, or several, as the tree sees them.
struct LightBound {
  Bounds box;
  Vec3 axis{0.0f, 0.0f, 1.0f};  // unit; Lambert's cosine is taken from the nearest direction
  float spread = 0.0f;          // within this angle (radians) of the axis
  float strength = 0.0f;        // sum of intensities along the axes, W/sr
};

class LightTree {
 public:
  LightTree() = default;
  /// Numbers in choices are indices into `lights`, whose strengths are above zero.
  explicit LightTree(std::span<const LightBound> lights);

  bool empty() const { return nodes_.empty(); }

  /// About the irradiance that all lights together make at most at a point of a surface with that
  /// normal; above zero.
  float importance(const Vec3& point, const Vec3& normal) const;

  struct Choice {
    std::uint32_t light = 0;
    float probability = 0.0f;
    float rest = 0.0f;  // what is left of the random number, in [0, 1)
  };
  /// The light that u in [0, 1) chooses. Must not be empty().
  Choice choose(const Vec3& point, const Vec3& normal, float u) const;

  /// The probability that choose() takes that light.
  float probability(std::uint32_t light, const Vec3& point, const Vec3& normal) const;

 private:
  struct Node {
    Vec3 centre{0.0f};
    float radius2 = 0.0f;  // of the sphere around the box
    Vec3 axis{0.0f};
    float cos_spread = 1.0f, sin_spread = 0.0f;
    float strength = 0.0f;
    std::uint32_t parent = 0;
    std::uint32_t first = 0;  // child, its twin follows; of a leaf the light
    bool leaf = false;
  };

  static float importance(const Node& node, const Vec3& point, const Vec3& normal);
  LightBound build(std::uint32_t node, std::span<std::uint32_t> lights,
                   std::span<const LightBound> bounds);
  void set(Node& node, const LightBound& bound);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  // node of each light
};

}  // namespace lantern
