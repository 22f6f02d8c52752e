// SPDX-License-Identifier: MIT
// Any text as an Ogre material script: each of its materials or an Error comes out.
#include "lantern/core/error.h"
#include "lantern/load/ogre_material.h"
#include "lantern/load/ogre_script.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  lantern::Loaded loaded;
  lantern::ogre::Materials materials(loaded.scene, loaded.report, {});
  try {
    materials.add_script(text, "fuzz");
  } catch (const lantern::Error&) {
    return 0;
  }
  for (const auto& statement : lantern::ogre::parse_script(text, "fuzz")) {
    for (const auto& word : statement.words) {
      if (!materials.defines(word.text)) continue;
      try {
        materials.use(word.text, {{"alias", "other.png"}});
      } catch (const lantern::Error&) {
      }
    }
  }
  return 0;
}
