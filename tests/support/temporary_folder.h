// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

namespace lantern::test {

/// A fresh folder that goes with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The folder `name` of the shared material beside the checkout (scenes/ogre, reference), if it is
/// there; LANTERN_SHARED names another place for it. Tests that need it skip without it.
std::optional<std::filesystem::path> shared_folder(const std::filesystem::path& name);

}  // namespace lantern::test
