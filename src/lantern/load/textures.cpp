// SPDX-License-Identifier: MIT
#include "lantern/load/textures.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/read.h"

#include <utility>

namespace lantern {
namespace {

Texture missing_texture() {
  Texture texture;
  texture.width = texture.height = 8;
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      const std::uint8_t magenta = (x + y) % 2 == 0 ? 255 : 0;
      texture.srgb8.insert(texture.srgb8.end(), {magenta, 0, magenta, 255});
    }
  }
  return texture;
}

Texture decode(std::span<const std::byte> bytes, const std::string& name) {
  Raster raster = decode_raster(bytes, name);
  Texture texture;
  texture.width = raster.width;
  texture.height = raster.height;
  texture.srgb8 = std::move(raster.srgb8);
  texture.linear = std::move(raster.linear);
  return texture;
}

}  // namespace

TextureId TextureCache::add(const Key& key, Texture texture) {
  std::tie(texture.name, texture.wrap_u, texture.wrap_v) = key;
  const auto id = to_id<TextureId>(scene_.textures.size());
  scene_.textures.push_back(std::move(texture));
  known_.emplace(key, id);
  return id;
}

std::optional<TextureId> TextureCache::load(const std::filesystem::path& file, Wrap u, Wrap v) {
  if (file.empty()) return std::nullopt;
  const Key key{file.lexically_normal().string(), u, v};
  if (const auto found = known_.find(key); found != known_.end()) return found->second;

  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    report_.warn(fmt::format("{}: no such texture; a checker stands in", file.string()));
    return add(key, missing_texture());
  }
  return add(key, decode(read_file(file), file.string()));
}

std::optional<TextureId> TextureCache::load_bytes(std::span<const std::byte> bytes,
                                                  const std::string& name, Wrap u, Wrap v) {
  if (bytes.empty()) return std::nullopt;
  const Key key{name, u, v};
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  return add(key, decode(bytes, name));
}

}  // namespace lantern
