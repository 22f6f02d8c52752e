// SPDX-License-Identifier: MIT
// The texts of the shaders, by names like "shaders/full_screen.vert.glsl": those built into the
// library, or a folder's while somebody works on them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace lantern::gl {

using FileTexts = std::map<std::string, std::string>;

/// What the build put into the library.
const FileTexts& embedded_files();

class ShaderFiles {
 public:
  /// The embedded files or, where the environment variable LANTERN_SHADERS names the folder that
  /// holds `shaders/`, its files as they are when they are asked for.
  ShaderFiles();
  explicit ShaderFiles(FileTexts texts) : texts_(std::move(texts)) {}
  explicit ShaderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// None: there is no such file. Throws Error if it cannot be read.
  std::optional<std::string> find(const std::string& name) const;

 private:
  FileTexts texts_;
  std::optional<std::filesystem::path> folder_;
};

}  // namespace lantern::gl
