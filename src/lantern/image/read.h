// SPDX-License-Identifier: MIT
// Picture files into linear floats. Errors: Error with the path, also for pictures whose claimed
// size the file cannot hold or memory should not (over 2^28 pixels). Values that are not finite
// come through as they are.
#pragma once

#include "lantern/image/image.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lantern {

/// RGBA texels of any readable picture, row 0 at the top. Just one vector is filled: `srgb8` for
/// 8-bit files (as stored, 4 bytes a pixel), `linear` for EXR, HDR and PFM (4 floats a pixel).
/// Alpha is 255 or 1 where the file has none.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> srgb8;
  std::vector<float> linear;
};

/// EXR, HDR, PFM, PNG, JPEG, TGA, BMP; the content decides, not the name. `name` is for messages.
/// EXR: one flat part, scan lines or tiles (the finest level), channels R G B or Y, A optional; the
/// picture is the data window. PNG of 16 bits is rounded to 8. JPEG: not CMYK,
/// not arithmetic coding. The scale of a PFM is not
/// applied; EXPOSURE of an HDR is undone, so that radiance comes out.
Raster decode_raster(std::span<const std::byte> bytes, const std::string& name);

/// A picture as linear radiance (8-bit files are decoded from sRGB, alpha is dropped).
Image read_image(const std::filesystem::path& path);

/// The metadata of an EXR or PNG that write_image() made; empty for other kinds.
Metadata read_metadata(const std::filesystem::path& path);

}  // namespace lantern
