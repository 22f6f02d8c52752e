// SPDX-License-Identifier: MIT
#include "lantern/image/write.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/codec.h"

#include <cassert>

namespace lantern {
namespace {

codec::Bytes encode(const std::filesystem::path& path, const Image& image,
                    const WriteOptions& options) {
  const std::string kind = extension(path);
  if (kind == ".exr") return codec::encode_exr(image, options, path.string());
  if (kind == ".png") return codec::encode_png(image, options, path.string());
  if (kind == ".hdr") return codec::encode_hdr(image, options);
  return codec::encode_pfm(image);
}

}  // namespace

void require_image_format(const std::filesystem::path& path) {
  const std::string kind = extension(path);
  if (kind == ".exr" || kind == ".png" || kind == ".hdr" || kind == ".pfm") return;
  fail({path.string()}, "is no picture format to write: .exr, .png, .hdr or .pfm");
}

void write_image(const std::filesystem::path& path, const Image& image,
                 const WriteOptions& options) {
  require_image_format(path);
  codec::check_size(image.width, image.height, path.string());
  assert(image.pixels.size() ==
         static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  write_file(path, encode(path, image, options));
}

std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgba) {
  return codec::encode_png(width, height, rgba);
}

}  // namespace lantern
