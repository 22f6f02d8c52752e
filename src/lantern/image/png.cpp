// SPDX-License-Identifier: MIT
// libpng reports errors with longjmp, so what is between setjmp and a call of it has nothing to
// destroy.
#include "lantern/core/error.h"
#include "lantern/image/codec.h"

#include <png.h>

#include <algorithm>
#include <cassert>
#include <csetjmp>
#include <cstring>

namespace lantern::codec {
namespace {

/// The longest keyword that PNG allows.
constexpr std::size_t kLongestKey = 79;

struct Problem {
  char text[128] = "";
};

void on_error(png_structp png, png_const_charp message) {
  auto* problem = static_cast<Problem*>(png_get_error_ptr(png));
  std::strncpy(problem->text, message, sizeof problem->text - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Writer {
  Writer() : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &problem, on_error, on_warning)) {
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
      png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }

  Problem problem;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct Reader {
  Reader() : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &problem, on_error, on_warning)) {
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }

  Problem problem;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

void append(png_structp png, png_bytep data, std::size_t size) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  const auto* from = reinterpret_cast<const std::byte*>(data);
  try {
    bytes.insert(bytes.end(), from, from + size);
    return;
  } catch (const std::exception&) {
    // The jump must not leave a handler: it happens below.
  }
  png_error(png, "out of memory");
}

void flush_nothing(png_structp) {}

void take(png_structp png, png_bytep to, std::size_t size) {
  auto& rest = *static_cast<View*>(png_get_io_ptr(png));
  if (size > rest.size()) png_error(png, "the file ends too early");
  std::memcpy(to, rest.data(), size);
  rest = rest.subspan(size);
}

/// The texts as libpng takes them, and what they point to.
struct Texts {
  explicit Texts(const Metadata& metadata) {
    for (const auto& [key, value] : metadata) {
      keys.push_back(std::string(kKeyPrefix) + key);
      values.push_back(value);
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      png_text text{};
      // tEXt is Latin-1 by definition, iTXt is UTF-8.
      const bool ascii = std::all_of(values[i].begin(), values[i].end(),
                                     [](char c) { return static_cast<unsigned char>(c) < 0x80; });
      text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
      text.key = keys[i].data();
      text.text = values[i].data();
      (ascii ? text.text_length : text.itxt_length) = values[i].size();
      texts.push_back(text);
    }
  }
  Texts(const Texts&) = delete;
  Texts& operator=(const Texts&) = delete;

  std::vector<std::string> keys;
  std::vector<std::string> values;
  std::vector<png_text> texts;
};

/// 8-bit channels, row by row.
struct Pixels {
  int width, height;
  int channels;  // 3: RGB, 4: RGBA
  const std::uint8_t* bytes;
};

bool write_all(Writer& writer, const Pixels& pixels, Texts& texts) {
  png_structp png = writer.png;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, writer.info, static_cast<png_uint_32>(pixels.width),
               static_cast<png_uint_32>(pixels.height), 8,
               pixels.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, writer.info, texts.texts.data(), static_cast<int>(texts.texts.size()));
  png_write_info(png, writer.info);
  const auto row =
      static_cast<std::size_t>(pixels.channels) * static_cast<std::size_t>(pixels.width);
  for (int y = 0; y < pixels.height; ++y) {
    png_write_row(png, pixels.bytes + row * static_cast<std::size_t>(y));
  }
  png_write_end(png, nullptr);
  return true;
}

Bytes encode(const Pixels& pixels, const Metadata& metadata, const std::string& name) {
  Texts texts(metadata);
  for (const std::string& key : texts.keys) {
    if (key.size() > kLongestKey) fail({name}, "PNG has no room for the key {}", key);
  }
  Bytes bytes;
  Writer writer;
  png_set_write_fn(writer.png, &bytes, append, flush_nothing);
  if (!write_all(writer, pixels, texts)) {
    fail({name}, "cannot be written as PNG: {}", writer.problem.text);
  }
  return bytes;
}

/// libpng makes room for a chunk as long as it claims to be. A chunk is its length, a name of 4
/// bytes, the content and 4 bytes of check sum.
void check_chunk_lengths(View bytes, const std::string& name) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kFrame = 12;
  for (std::size_t at = kSignature; at < bytes.size();) {
    const View rest = bytes.subspan(at);
    if (rest.size() < kFrame) return;  // libpng finds that the file ends early, or does not care
    const std::uint32_t length = png_get_uint_32(reinterpret_cast<png_const_bytep>(rest.data()));
    if (length > rest.size() - kFrame) {
      fail({name, {}, {}, at}, "a PNG chunk of {} bytes does not fit into the file", length);
    }
    if (std::memcmp(rest.data() + 4, "IEND", 4) == 0) return;
    at += kFrame + length;
  }
}

/// `rest` is behind the header afterwards.
bool read_header(Reader& reader, View& rest) {
  // Compressed texts may unfold to this many bytes in each of this many chunks.
  constexpr png_alloc_size_t kLongestText = png_alloc_size_t{8} << 20;
  constexpr png_uint_32 kMostTexts = 128;
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_chunk_malloc_max(reader.png, kLongestText);
  png_set_chunk_cache_max(reader.png, kMostTexts);
  png_set_read_fn(reader.png, &rest, take);
  png_read_info(reader.png, reader.info);
  return true;
}

/// Whatever the file stores, as 4 bytes a pixel.
bool read_rows(Reader& reader, std::size_t width, std::size_t height, std::uint8_t* texels) {
  png_structp png = reader.png;
  constexpr png_uint_32 kOpaque = 255;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, kOpaque, PNG_FILLER_AFTER);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  if (png_get_rowbytes(png, reader.info) != 4 * width) png_error(png, "unknown kind of pixels");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t y = 0; y < height; ++y) png_read_row(png, texels + 4 * width * y, nullptr);
  }
  png_read_end(png, nullptr);
  return true;
}

}  // namespace

bool is_png(View bytes) { return starts_with(bytes, "\x89PNG\r\n\x1a\n"); }

Raster decode_png(View bytes, const std::string& name) {
  check_chunk_lengths(bytes, name);
  Reader reader;
  View rest = bytes;
  if (!read_header(reader, rest)) fail({name}, "broken PNG: {}", reader.problem.text);
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  check_size(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), name);
  constexpr std::size_t kDeflateLimit = 1032;  // 258 bytes take 2 bits at least
  if (png_get_rowbytes(reader.png, reader.info) * height > bytes.size() * kDeflateLimit) {
    fail({name}, "a PNG of {} bytes cannot hold a picture of {}x{}", bytes.size(), width, height);
  }
  Raster raster{static_cast<int>(width),
                static_cast<int>(height),
                std::vector<std::uint8_t>(4 * width * height),
                {}};
  if (!read_rows(reader, width, height, raster.srgb8.data())) {
    fail({name}, "broken PNG: {}", reader.problem.text);
  }
  return raster;
}

Metadata png_metadata(View bytes, const std::string& name) {
  check_chunk_lengths(bytes, name);
  Reader reader;
  if (!read_header(reader, bytes)) fail({name}, "broken PNG: {}", reader.problem.text);
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &texts, &count);
  Metadata metadata;
  for (const png_text& text : std::span(texts, static_cast<std::size_t>(count))) {
    const std::string_view key = text.key;
    if (key.starts_with(kKeyPrefix)) metadata.emplace(key.substr(kKeyPrefix.size()), text.text);
  }
  return metadata;
}

Bytes encode_png(const Image& image, const WriteOptions& options, const std::string& name) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * image.pixels.size());
  for (const Rgb& radiance : image.pixels) {
    const auto shown = to_srgb8(radiance, options.tone);
    rgb.insert(rgb.end(), shown.begin(), shown.end());
  }
  return encode({image.width, image.height, 3, rgb.data()}, options.metadata, name);
}

Bytes encode_png(int width, int height, std::span<const std::uint8_t> rgba) {
  assert(rgba.size() == 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return encode({width, height, 4, rgba.data()}, {}, "a texture");
}

}  // namespace lantern::codec
