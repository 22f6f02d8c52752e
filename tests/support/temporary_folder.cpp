// SPDX-License-Identifier: MIT
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace lantern::test {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "lantern-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::optional<std::filesystem::path> shared_folder(const std::filesystem::path& name) {
  const char* given = std::getenv("LANTERN_SHARED");
  const std::filesystem::path base =
      given ? given : std::filesystem::path(LANTERN_SOURCE_DIR) / "../shared";
  if (!std::filesystem::is_directory(base / name)) return std::nullopt;
  return base / name;
}

}  // namespace lantern::test
