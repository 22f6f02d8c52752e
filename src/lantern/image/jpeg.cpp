// SPDX-License-Identifier: MIT
// libjpeg reports errors through a function that may not return, so what is between setjmp and a
// call of it has nothing to destroy.
#include "lantern/core/error.h"
#include "lantern/image/codec.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>
#include <jerror.h>

namespace lantern::codec {
namespace {

struct Problem {
  jpeg_error_mgr manager;  // first, so that libjpeg's pointer to it is one to this
  std::jmp_buf jump;
  char text[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
  auto* problem = reinterpret_cast<Problem*>(jpeg->err);
  jpeg->err->format_message(jpeg, problem->text);
  std::longjmp(problem->jump, 1);
}

/// libjpeg only warns of a file that ends early, and invents the rest.
void on_message(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) on_error(jpeg);
}

/// Every scan of a progressive picture costs time for all of it, but hardly any bytes.
void on_progress(j_common_ptr common) {
  constexpr int kMostScans = 100;  // programs write about 10
  auto* jpeg = reinterpret_cast<j_decompress_ptr>(common);
  if (jpeg->input_scan_number > kMostScans) ERREXIT(jpeg, JERR_BAD_PROGRESSION);
}

struct Decoder {
  Decoder() {
    jpeg.err = jpeg_std_error(&problem.manager);
    problem.manager.error_exit = on_error;
    problem.manager.emit_message = on_message;
    progress.progress_monitor = on_progress;
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { jpeg_destroy_decompress(&jpeg); }

  Problem problem{};
  jpeg_decompress_struct jpeg{};
  jpeg_progress_mgr progress{};
};

bool read_header(Decoder& decoder, View bytes) {
  if (setjmp(decoder.problem.jump)) return false;
  jpeg_create_decompress(&decoder.jpeg);
  decoder.jpeg.progress = &decoder.progress;
  jpeg_mem_src(&decoder.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder.jpeg, TRUE);
  return true;
}

bool read_rows(Decoder& decoder, std::uint8_t* texels) {
  jpeg_decompress_struct& jpeg = decoder.jpeg;
  if (setjmp(decoder.problem.jump)) return false;
  jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = texels + std::size_t{4} * jpeg.output_width * jpeg.output_scanline;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

bool is_jpeg(View bytes) { return starts_with(bytes, "\xff\xd8\xff"); }

Raster decode_jpeg(View bytes, const std::string& name) {
  Decoder decoder;
  if (!read_header(decoder, bytes)) fail({name}, "broken JPEG: {}", decoder.problem.text);
  const std::size_t width = decoder.jpeg.image_width;
  const std::size_t height = decoder.jpeg.image_height;
  check_size(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), name);
  if (decoder.jpeg.arith_code) fail({name}, "a JPEG with arithmetic coding cannot be read");
  // A Huffman code has at least one bit for each block of 8x8 samples, and subsampling stretches a
  // block over 16 times as many pixels at most.
  constexpr std::size_t kMostPixelsPerByte = 8 * 8 * 8 * 16;
  if (width * height > bytes.size() * kMostPixelsPerByte) {
    fail({name}, "a JPEG of {} bytes cannot hold a picture of {}x{}", bytes.size(), width, height);
  }
  Raster raster{static_cast<int>(width),
                static_cast<int>(height),
                std::vector<std::uint8_t>(4 * width * height),
                {}};
  if (!read_rows(decoder, raster.srgb8.data())) {
    fail({name}, "broken JPEG: {}", decoder.problem.text);
  }
  return raster;
}

}  // namespace lantern::codec
