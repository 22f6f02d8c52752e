// SPDX-License-Identifier: MIT
// Strong ids: an index into the vector of that kind of thing in a Scene.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lantern {

enum class MeshId : std::uint32_t {};
enum class MaterialId : std::uint32_t {};
enum class TextureId : std::uint32_t {};

template <typename Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

template <typename Id>
constexpr Id to_id(std::size_t i) {
  return static_cast<Id>(i);
}

}  // namespace lantern
