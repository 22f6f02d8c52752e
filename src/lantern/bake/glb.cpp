// SPDX-License-Identifier: MIT
#include "lantern/bake/glb.h"

#include "lantern/core/error.h"
#include "lantern/core/version.h"

#include <bit>
#include <cassert>
#include <limits>
#include <string>

namespace lantern {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF stores little-endian numbers");

// Constants of the format.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::size_t kAlignment = 4;

template <typename T>
std::span<const std::byte> bytes_of(std::span<const T> values) {
  return std::as_bytes(values);
}

void pad(std::vector<std::byte>& bytes, char with) {
  while (bytes.size() % kAlignment != 0) bytes.push_back(static_cast<std::byte>(with));
}

void append(std::vector<std::byte>& to, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) to.push_back(static_cast<std::byte>(value >> shift));
}

void append_chunk(std::vector<std::byte>& to, const char (&kind)[5],
                  std::span<const std::byte> content) {
  append(to, static_cast<std::uint32_t>(content.size()));
  for (int i = 0; i < 4; ++i) to.push_back(static_cast<std::byte>(kind[i]));
  to.insert(to.end(), content.begin(), content.end());
}

}  // namespace

Glb::Glb() {
  json["asset"] = {{"version", "2.0"}, {"generator", std::string("lantern ") + kVersion}};
}

std::size_t Glb::add_view(std::span<const std::byte> content) {
  pad(buffer_, '\0');
  views_.push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", content.size()}});
  buffer_.insert(buffer_.end(), content.begin(), content.end());
  return views_.size() - 1;
}

std::size_t Glb::add_accessor(std::span<const std::byte> content, std::size_t count, int component,
                              const char* type, int target) {
  assert(count > 0);
  const std::size_t view = add_view(content);
  views_[view]["target"] = target;
  accessors_.push_back(
      {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  return accessors_.size() - 1;
}

std::size_t Glb::add(std::span<const Vec2> values) {
  return add_accessor(bytes_of(values), values.size(), kFloat, "VEC2", kArrayBuffer);
}

std::size_t Glb::add(std::span<const Vec3> values, bool with_bounds) {
  const std::size_t accessor =
      add_accessor(bytes_of(values), values.size(), kFloat, "VEC3", kArrayBuffer);
  if (with_bounds) {
    Bounds bounds;
    for (const Vec3& value : values) bounds.add(value);
    accessors_[accessor]["min"] = {bounds.low.x, bounds.low.y, bounds.low.z};
    accessors_[accessor]["max"] = {bounds.high.x, bounds.high.y, bounds.high.z};
  }
  return accessor;
}

std::size_t Glb::add(std::span<const Vec4> values) {
  return add_accessor(bytes_of(values), values.size(), kFloat, "VEC4", kArrayBuffer);
}

std::size_t Glb::add_indices(std::span<const std::uint32_t> values) {
  return add_accessor(bytes_of(values), values.size(), kUnsignedInt, "SCALAR", kElementArrayBuffer);
}

std::size_t Glb::add_png(std::span<const std::byte> file) {
  json["images"].push_back({{"bufferView", add_view(file)}, {"mimeType", "image/png"}});
  return json["images"].size() - 1;
}

std::vector<std::byte> Glb::bytes() const {
  std::vector<std::byte> buffer = buffer_;
  pad(buffer, '\0');
  Json whole = json;
  whole["buffers"] = {{{"byteLength", buffer.size()}}};
  whole["bufferViews"] = views_;
  whole["accessors"] = accessors_;
  const std::string text = whole.dump();
  const auto characters = std::as_bytes(std::span(text));
  std::vector<std::byte> head(characters.begin(), characters.end());
  pad(head, ' ');

  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const std::size_t total = kHeader + 2 * kChunkHeader + head.size() + buffer.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("the GLB would have {} bytes; the format ends at 4 GiB", total));
  }
  std::vector<std::byte> file;
  file.reserve(total);
  for (const char c : {'g', 'l', 'T', 'F'}) file.push_back(static_cast<std::byte>(c));
  constexpr std::uint32_t kVersionOfContainer = 2;
  append(file, kVersionOfContainer);
  append(file, static_cast<std::uint32_t>(total));
  append_chunk(file, "JSON", head);
  append_chunk(file, {'B', 'I', 'N', '\0', '\0'}, buffer);
  return file;
}

}  // namespace lantern
