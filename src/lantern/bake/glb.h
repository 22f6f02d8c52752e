// SPDX-License-Identifier: MIT
// A binary glTF 2.0 file in the making: JSON that the caller fills, and one buffer that arrays and
// pictures are added to, aligned as the format wants. [Khronos, glTF 2.0, sections 3.6 and 4]
#pragma once

#include "lantern/core/math.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

class Glb {
 public:
  /// Everything but `buffers`, `bufferViews` and `accessors`, which are filled from here.
  nlohmann::ordered_json json;

  Glb();

  /// Each returns the number of its accessor. `with_bounds` adds min and max, as positions need.
  std::size_t add(std::span<const Vec2> values);
  std::size_t add(std::span<const Vec3> values, bool with_bounds = false);
  std::size_t add(std::span<const Vec4> values);
  /// Vertices of triangles.
  std::size_t add_indices(std::span<const std::uint32_t> values);
  /// A PNG file; returns the number of its image.
  std::size_t add_png(std::span<const std::byte> file);

  /// The whole file.
  std::vector<std::byte> bytes() const;

 private:
  std::size_t add_view(std::span<const std::byte> content);
  std::size_t add_accessor(std::span<const std::byte> content, std::size_t count, int component,
                           const char* type, int target);

  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
  std::vector<std::byte> buffer_;
};

}  // namespace lantern
