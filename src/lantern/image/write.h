// SPDX-License-Identifier: MIT
// Pictures into files, whole or not at all. The extension decides the format. Errors: Error with
// the path.
#pragma once

#include "lantern/image/image.h"
#include "lantern/image/tone.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace lantern {

enum class ExrDepth { kHalf, kFloat };

struct WriteOptions {
  ExrDepth exr_depth = ExrDepth::kHalf;
  Tone tone;          // PNG only: HDR formats keep radiance as it is
  Metadata metadata;  // EXR attributes, PNG text chunks, HDR comments; PFM has no place for it
};

/// Throws Error unless `path` ends in .exr, .png, .hdr or .pfm.
void require_image_format(const std::filesystem::path& path);

/// Half EXR: beyond ±65504 that number is written. HDR: negative values and NaN become 0, values
/// beyond 2^127 that number, and channels are rounded to 1/256 of the largest of their pixel.
/// Float EXR and PFM keep every value, also those that are not finite.
void write_image(const std::filesystem::path& path, const Image& image,
                 const WriteOptions& options = {});

/// The bytes of a PNG file: sRGB colours and alpha, 4 bytes a pixel, row by row.
std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgba);

}  // namespace lantern
