// SPDX-License-Identifier: MIT
// Connected parts of a World, so that of a picture what lies beside it is left out part by part,
// and of convex ones what is turned away.
#pragma once

#include "lantern/scene/world.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// Which side of all of a body's triangles is seen from outside the sphere around it.
enum class SeenSide { kBoth, kFront, kBack };

/// A run of an order of triangles.
struct Body {
  std::uint32_t first = 0, count = 0;
  Vec3 centre{0.0f};  // of a sphere around it
  float radius = 0.0f;
  SeenSide outside = SeenSide::kBoth;
};

/// What is connected by edges.
struct Parts {
  std::vector<std::uint32_t> of_triangle;  // the number of the part that it is in
  std::vector<std::uint32_t> sizes;        // in triangles
};

/// `neighbours` of find_neighbours().
Parts find_parts(std::span<const std::array<std::uint32_t, 3>> neighbours);

/// Brings the triangles into an order in which those of a part follow each other, and cuts that
/// into bodies; small parts are one together. `before` others come first in a longer order.
std::vector<Body> make_bodies(const World& world,
                              std::span<const std::array<std::uint32_t, 3>> neighbours,
                              const Parts& parts, std::span<std::uint32_t> triangles,
                              std::uint32_t before = 0);

/// Whether some of the body may lie on the positive side of all planes, whose normals have
/// length 1.
bool may_lie_inside(const Body& body, std::span<const Vec4> planes);

/// Which side of its triangles is seen from here.
SeenSide seen_side(const Body& body, const Vec3& from);

}  // namespace lantern
