// SPDX-License-Identifier: MIT
#include "lantern/path/light_tree.h"

#include "lantern/core/hash.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace lantern {
namespace {

/// Cosines count as at least this: a bound must not vanish by rounding, nor a branch by a bound.
constexpr float kLeastCosine = 0.02f;

/// In m², so that nothing is divided by zero where a light has no extent.
constexpr float kLeastDistance2 = 1e-20f;

/// cos(max(0, a - b)) for angles in [0, pi] given by their cosines and sines.
float cos_beyond(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a >= cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}

float sine_of(float cosine) { return std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)); }

/// Both together, around the mean of their axes by strength.
LightBound unite(const LightBound& a, const LightBound& b) {
  LightBound both = a;
  both.box.add(b.box.low);
  both.box.add(b.box.high);
  both.strength = a.strength + b.strength;
  const Vec3 sum = a.axis * a.strength + b.axis * b.strength;
  const float length = glm::length(sum);
  // Opposite axes have no mean.
  constexpr float kShortest = 1e-3f;
  if (length < kShortest * both.strength) {
    both.spread = kPi;
    return both;
  }
  both.axis = sum / length;
  const auto reach = [&](const LightBound& part) {
    return std::acos(std::clamp(glm::dot(both.axis, part.axis), -1.0f, 1.0f)) + part.spread;
  };
  both.spread = std::min(kPi, std::max(reach(a), reach(b)));
  return both;
}

}  // namespace

LightTree::LightTree(std::span<const LightBound> lights) : leaf_of_(lights.size()) {
  if (lights.empty()) return;
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * lights.size());
  nodes_.emplace_back();
  build(0, order, lights);
}

LightBound LightTree::build(std::uint32_t node, std::span<std::uint32_t> lights,
                            std::span<const LightBound> bounds) {
  if (lights.size() == 1) {
    nodes_[node].leaf = true;
    nodes_[node].first = lights[0];
    leaf_of_[lights[0]] = node;
    set(nodes_[node], bounds[lights[0]]);
    return bounds[lights[0]];
  }
  Bounds centres;
  for (const std::uint32_t i : lights) centres.add(bounds[i].box.centre());
  const Vec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = lights.size() / 2;
  std::nth_element(lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(half), lights.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float at_a = bounds[a].box.centre()[axis];
                     const float at_b = bounds[b].box.centre()[axis];
                     return at_a != at_b ? at_a < at_b : a < b;
                   });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = first;
  nodes_.resize(nodes_.size() + 2);
  nodes_[first].parent = nodes_[first + 1].parent = node;
  const LightBound near = build(first, lights.first(half), bounds);
  const LightBound both = unite(near, build(first + 1, lights.subspan(half), bounds));
  set(nodes_[node], both);
  return both;
}

void LightTree::set(Node& node, const LightBound& bound) {
  node.centre = bound.box.centre();
  const Vec3 diagonal = bound.box.high - bound.box.low;
  node.radius2 = 0.25f * glm::dot(diagonal, diagonal);
  node.axis = bound.axis;
  node.cos_spread = std::cos(bound.spread);
  node.sin_spread = std::sin(bound.spread);
  node.strength = bound.strength;
}

float LightTree::importance(const Node& node, const Vec3& point, const Vec3& normal) {
  const Vec3 to_light = node.centre - point;
  const float distance2 = glm::dot(to_light, to_light);
  // Within the sphere everything is possible.
  if (distance2 <= std::max(node.radius2, kLeastDistance2)) {
    return node.strength / std::max(node.radius2, kLeastDistance2);
  }
  const Vec3 direction = to_light / std::sqrt(distance2);
  const float sin2 = node.radius2 / distance2;  // of the angle that the sphere is seen under
  const float sin_seen = std::sqrt(sin2), cos_seen = std::sqrt(1.0f - sin2);
  const float cos_point = glm::dot(normal, direction);
  const float at_point = cos_beyond(cos_point, sine_of(cos_point), cos_seen, sin_seen);
  const float cos_light = -glm::dot(node.axis, direction);
  // First beyond the spread, then beyond what the sphere covers.
  const float beyond = cos_beyond(cos_light, sine_of(cos_light), node.cos_spread, node.sin_spread);
  const float at_light = cos_beyond(beyond, sine_of(beyond), cos_seen, sin_seen);
  return node.strength * std::max(kLeastCosine, at_point) * std::max(kLeastCosine, at_light) /
         distance2;
}

float LightTree::importance(const Vec3& point, const Vec3& normal) const {
  return importance(nodes_.front(), point, normal);
}

LightTree::Choice LightTree::choose(const Vec3& point, const Vec3& normal, float u) const {
  assert(!empty() && u >= 0.0f && u < 1.0f);
  const Node* node = &nodes_.front();
  float probability = 1.0f;
  while (!node->leaf) {
    const Node* child = &nodes_[node->first];
    const float a = importance(child[0], point, normal), b = importance(child[1], point, normal);
    const float of_first = a / (a + b);
    if (u < of_first) {
      u /= of_first;
      probability *= of_first;
      node = child;
    } else {
      u = (u - of_first) / (1.0f - of_first);
      probability *= 1.0f - of_first;
      node = child + 1;
    }
    u = std::min(u, kBelowOne);
  }
  return {node->first, probability, u};
}

float LightTree::probability(std::uint32_t light, const Vec3& point, const Vec3& normal) const {
  float probability = 1.0f;
  for (std::uint32_t at = leaf_of_[light]; at != 0; at = nodes_[at].parent) {
    const std::uint32_t first = nodes_[nodes_[at].parent].first;
    const float a = importance(nodes_[first], point, normal);
    const float b = importance(nodes_[first + 1], point, normal);
    const float of_first = a / (a + b);
    probability *= at == first ? of_first : 1.0f - of_first;
  }
  return probability;
}

}  // namespace lantern
