// SPDX-License-Identifier: MIT
// Picture files and embedded pictures into textures of a scene, each read once. A file that is not
// there gives a checker nobody can overlook and a warning. Errors: Error with the path for a file
// that cannot be read or is no picture.
#pragma once

#include "lantern/load/load.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>

namespace lantern {

class TextureCache {
 public:
  /// Adds to `scene` and warns in `report`; both must outlive the cache.
  explicit TextureCache(Scene& scene, LoadReport& report) : scene_(scene), report_(report) {}

  /// The texture of `file`, the same one for the same file and wrapping; none for an empty path.
  std::optional<TextureId> load(const std::filesystem::path& file, Wrap u, Wrap v);

  /// The same for the bytes of a picture file that is embedded in another one; `name` identifies
  /// it there and in messages. None for no bytes.
  std::optional<TextureId> load_bytes(std::span<const std::byte> bytes, const std::string& name,
                                      Wrap u, Wrap v);

 private:
  using Key = std::tuple<std::string, Wrap, Wrap>;

  TextureId add(const Key& key, Texture texture);

  Scene& scene_;
  LoadReport& report_;
  std::map<Key, TextureId> known_;
};

}  // namespace lantern
