// SPDX-License-Identifier: MIT
// Any text as a DotScene: nodes multiplied out or an Error comes out.
#include "lantern/core/error.h"
#include "lantern/load/dotscene.h"
#include "lantern/scene/validate.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    lantern::LoadReport report;
    auto parsed = lantern::ogre::parse_dotscene(
        std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", report);
    lantern::Scene scene;
    scene.cameras = std::move(parsed.cameras);
    scene.lights = std::move(parsed.lights);
    scene.sky = parsed.sky;
    lantern::validate(scene, "fuzz");
  } catch (const lantern::Error&) {
  }
  return 0;
}
