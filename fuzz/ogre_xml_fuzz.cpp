// SPDX-License-Identifier: MIT
// Any text as an Ogre XML mesh: a valid Scene or an Error comes out.
#include "lantern/core/error.h"
#include "lantern/load/ogre_mesh.h"
#include "lantern/load/ogre_xml.h"
#include "lantern/scene/validate.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    lantern::Loaded loaded;
    const auto mesh = lantern::ogre::parse_xml(
        std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", loaded.report);
    lantern::ogre::Materials materials(loaded.scene, loaded.report, {});
    lantern::ogre::add_meshes(mesh, materials);
    lantern::validate(loaded.scene, "fuzz");
  } catch (const lantern::Error&) {
  }
  return 0;
}
