// SPDX-License-Identifier: MIT
// Any bytes as an Ogre binary mesh: a valid Scene or an Error comes out, in less than 2 GB.
#include "lantern/core/error.h"
#include "lantern/load/ogre_binary.h"
#include "lantern/load/ogre_mesh.h"
#include "lantern/scene/validate.h"

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    lantern::Loaded loaded;
    const auto mesh =
        lantern::ogre::parse_binary(std::as_bytes(std::span(data, size)), "fuzz", loaded.report);
    lantern::ogre::Materials materials(loaded.scene, loaded.report, {});
    lantern::ogre::add_meshes(mesh, materials);
    lantern::validate(loaded.scene, "fuzz");
  } catch (const lantern::Error&) {
  }
  return 0;
}
