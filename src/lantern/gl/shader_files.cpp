// SPDX-License-Identifier: MIT
#include "lantern/gl/shader_files.h"

#include "lantern/core/file.h"

#include <cstdlib>

namespace lantern::gl {

ShaderFiles::ShaderFiles() {
  if (const char* folder = std::getenv("LANTERN_SHADERS")) {
    folder_ = folder;
  } else {
    texts_ = embedded_files();
  }
}

std::optional<std::string> ShaderFiles::find(const std::string& name) const {
  if (folder_) {
    if (!std::filesystem::exists(*folder_ / name)) return std::nullopt;
    return read_text(*folder_ / name);
  }
  const auto found = texts_.find(name);
  if (found == texts_.end()) return std::nullopt;
  return found->second;
}

}  // namespace lantern::gl
