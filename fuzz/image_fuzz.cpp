// SPDX-License-Identifier: MIT
// Any bytes as a picture: a picture or an Error comes out, nothing else, in less than 2 GB.
#include "lantern/core/error.h"
#include "lantern/image/codec.h"
#include "lantern/image/read.h"

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes = std::as_bytes(std::span(data, size));
  try {
    lantern::decode_raster(bytes, "fuzz");
  } catch (const lantern::Error&) {
  }
  try {
    lantern::codec::decode_metadata(bytes, "fuzz");
  } catch (const lantern::Error&) {
  }
  return 0;
}
