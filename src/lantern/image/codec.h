// SPDX-License-Identifier: MIT
// The file formats behind read.h and write.h, from bytes and to bytes; nothing else includes this.
// `name` is the file in messages. Errors: Error with that name. No decoder asks for memory before
// it knows that the file is large enough for what it claims.
#pragma once

#include "lantern/image/read.h"
#include "lantern/image/write.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lantern::codec {

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

/// More pixels than this are taken for a mistake: 4 GiB as floats.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

/// Goes before our keys in files, so that they meet no attribute the format has a meaning for.
inline constexpr std::string_view kKeyPrefix = "lantern.";

/// Throws unless the sides are positive and the pixels not too many.
void check_size(std::int64_t width, std::int64_t height, const std::string& name);

bool starts_with(View bytes, std::string_view magic);
bool is_exr(View bytes);
bool is_jpeg(View bytes);
bool is_png(View bytes);
bool is_pfm(View bytes);

Raster decode_exr(View bytes, const std::string& name);
Raster decode_jpeg(View bytes, const std::string& name);
Raster decode_pfm(View bytes, const std::string& name);
Raster decode_png(View bytes, const std::string& name);
/// TGA, BMP and Radiance HDR.
Raster decode_stb(View bytes, const std::string& name);

/// Empty for a picture of another program or of a kind that keeps none.
Metadata decode_metadata(View bytes, const std::string& name);
Metadata exr_metadata(View bytes, const std::string& name);
Metadata png_metadata(View bytes, const std::string& name);

Bytes encode_exr(const Image& image, const WriteOptions& options, const std::string& name);
Bytes encode_hdr(const Image& image, const WriteOptions& options);
Bytes encode_pfm(const Image& image);
Bytes encode_png(const Image& image, const WriteOptions& options, const std::string& name);
Bytes encode_png(int width, int height, std::span<const std::uint8_t> rgba);

}  // namespace lantern::codec
