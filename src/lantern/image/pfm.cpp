// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/image/codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

namespace lantern::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are copied as they lie");

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The next word of the header; leaves `text` behind the one white space that ends it.
std::string_view take_word(std::string_view& text, const std::string& name) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  const auto end = std::find_if(text.begin(), text.end(), is_space);
  const auto length = static_cast<std::size_t>(end - text.begin());
  if (length == text.size()) fail({name}, "the header of the PFM is incomplete");
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length + 1);
  return word;
}

template <typename Number>
Number take_number(std::string_view& text, const std::string& name) {
  const std::string_view word = take_word(text, name);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) {
    fail({name}, "the header of the PFM holds no number where one belongs");
  }
  return number;
}

float big_endian_float(const char* bytes) {
  std::array<char, 4> reversed;
  std::reverse_copy(bytes, bytes + 4, reversed.begin());
  return std::bit_cast<float>(reversed);
}

}  // namespace

bool is_pfm(View bytes) { return starts_with(bytes, "PF") || starts_with(bytes, "Pf"); }

Raster decode_pfm(View bytes, const std::string& name) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string_view kind = take_word(text, name);
  if (kind != "PF" && kind != "Pf") fail({name}, "is no picture that can be read");
  const std::size_t channels = kind == "PF" ? 3 : 1;
  const int width = take_number<int>(text, name);
  const int height = take_number<int>(text, name);
  // The sign of the scale tells the order of the bytes.
  const bool little = take_number<double>(text, name) < 0.0;
  check_size(width, height, name);

  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  const std::size_t expected = w * h * channels * sizeof(float);
  if (text.size() < expected) {
    fail({name}, "a PFM of {}x{} needs {} bytes of pixels; the file has {}", width, height,
         expected, text.size());
  }
  Raster raster{width, height, {}, std::vector<float>(w * h * 4, 1.0f)};
  const char* from = text.data();
  for (std::size_t row = h; row-- > 0;) {
    for (std::size_t x = 0; x < w; ++x) {
      float* texel = &raster.linear[(row * w + x) * 4];
      for (std::size_t c = 0; c < channels; ++c, from += sizeof(float)) {
        if (little) {
          std::memcpy(texel + c, from, sizeof(float));
        } else {
          texel[c] = big_endian_float(from);
        }
      }
      if (channels == 1) texel[1] = texel[2] = texel[0];
    }
  }
  return raster;
}

Bytes encode_pfm(const Image& image) {
  const std::string header = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * sizeof(Rgb);
  Bytes bytes(header.size() + row_bytes * static_cast<std::size_t>(image.height));
  std::memcpy(bytes.data(), header.data(), header.size());
  std::byte* to = bytes.data() + header.size();
  for (int y = image.height; y-- > 0; to += row_bytes) {
    std::memcpy(to, &image.at(0, y), row_bytes);
  }
  return bytes;
}

}  // namespace lantern::codec
