// SPDX-License-Identifier: MIT
// Whatever the bytes of a glTF, GLB or OBJ are, loading ends in a scene or an Error.
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/load/load.h"

#include <cstdint>
#include <string_view>
#include <unistd.h>

namespace {

/// One file per process and format, written anew for each input.
std::filesystem::path input_file(std::string_view bytes) {
  const char* name = bytes.starts_with("glTF") ? "glb" : bytes.starts_with("{") ? "gltf" : "obj";
  return std::filesystem::temp_directory_path() /
         fmt::format("lantern-fuzz-{}.{}", ::getpid(), name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path path = input_file(bytes);
  try {
    lantern::write_file(path, bytes);
    lantern::load_scene(path);
  } catch (const lantern::Error&) {
  }
  std::filesystem::remove(path);
  return 0;
}
