// SPDX-License-Identifier: MIT
#include "lantern/image/read.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/codec.h"
#include "lantern/image/tone.h"

#include <array>
#include <cstring>
#include <new>

namespace lantern {
namespace codec {

void check_size(std::int64_t width, std::int64_t height, const std::string& name) {
  if (width < 1 || height < 1) fail({name}, "the picture has no pixels");
  if (width > kMostPixels || height > kMostPixels || width * height > kMostPixels) {
    fail({name}, "a picture of {}x{} has too many pixels; the limit is {}", width, height,
         kMostPixels);
  }
}

bool starts_with(View bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

Metadata decode_metadata(View bytes, const std::string& name) {
  if (is_exr(bytes)) return exr_metadata(bytes, name);
  if (is_png(bytes)) return png_metadata(bytes, name);
  return {};
}

}  // namespace codec

Raster decode_raster(std::span<const std::byte> bytes, const std::string& name) try {
  if (bytes.empty()) fail({name}, "the file is empty");
  if (codec::is_exr(bytes)) return codec::decode_exr(bytes, name);
  if (codec::is_jpeg(bytes)) return codec::decode_jpeg(bytes, name);
  if (codec::is_png(bytes)) return codec::decode_png(bytes, name);
  if (codec::is_pfm(bytes)) return codec::decode_pfm(bytes, name);
  return codec::decode_stb(bytes, name);
} catch (const std::bad_alloc&) {
  fail({name}, "the picture does not fit into memory");
}

Image read_image(const std::filesystem::path& path) {
  const Raster raster = decode_raster(read_file(path), path.string());
  Image image(raster.width, raster.height);
  if (!raster.linear.empty()) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const float* texel = &raster.linear[4 * i];
      image.pixels[i] = Rgb(texel[0], texel[1], texel[2]);
    }
    return image;
  }
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = srgb_to_linear(static_cast<float>(i) / 255.0f);
  }
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* texel = &raster.srgb8[4 * i];
    image.pixels[i] = Rgb(linear[texel[0]], linear[texel[1]], linear[texel[2]]);
  }
  return image;
}

Metadata read_metadata(const std::filesystem::path& path) {
  return codec::decode_metadata(read_file(path), path.string());
}

}  // namespace lantern
