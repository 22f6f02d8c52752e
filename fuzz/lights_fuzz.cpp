// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/lights/export.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    lantern::lights_from_json({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const lantern::Error&) {
  }
  return 0;
}
