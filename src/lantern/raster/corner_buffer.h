// SPDX-License-Identifier: MIT
// The world's arrays as GL draws triangles from them, corner by corner.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// One of the world's arrays, a value for each corner of the triangles in this order.
template <typename T>
gl::Buffer by_corner(const World& world, std::span<const std::uint32_t> order,
                     const std::vector<T>& values) {
  std::vector<T> corners;
  corners.reserve(3 * order.size());
  for (const std::uint32_t t : order) {
    for (int corner = 0; corner < 3; ++corner) {
      corners.push_back(values[world.triangles[t][corner]]);
    }
  }
  return gl::Buffer(std::span<const T>(corners));
}

/// A value of its triangle for each corner of the triangles in this order.
template <typename Value>
gl::Buffer for_corners(std::span<const std::uint32_t> order, const Value& value) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * order.size());
  for (const std::uint32_t t : order) corners.insert(corners.end(), 3, value(t));
  return gl::Buffer(std::span<const std::uint32_t>(corners));
}

/// The number of its triangle for each corner of the triangles in this order.
inline gl::Buffer numbers_by_corner(std::span<const std::uint32_t> order) {
  return for_corners(order, [](std::uint32_t t) { return t; });
}

}  // namespace lantern
