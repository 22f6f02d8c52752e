// SPDX-License-Identifier: MIT
// Radiance pictures: RGBE pixels in run-length coded scan lines [Ward 1991, Real Pixels; the file
// format is Radiance's own reference, filefmts.pdf].
#include "lantern/image/codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lantern::codec {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Three mantissas of 8 bits and the exponent of the largest. Rounded to nearest, for readers that
/// take the mantissa as it is (all but Radiance itself, which adds a half).
Rgbe to_rgbe(const Rgb& radiance) {
  constexpr float kLargest = 0x1.fep126f;  // mantissa 255, exponent 127
  Rgb c;
  for (int i = 0; i < 3; ++i) c[i] = radiance[i] > 0.0f ? std::min(radiance[i], kLargest) : 0.0f;
  int exponent = 0;
  if (255.5f <= 256.0f * std::frexp(max_component(c), &exponent)) ++exponent;
  constexpr int kBias = 128;
  if (max_component(c) == 0.0f || exponent + kBias < 1) return {};
  Rgbe rgbe;
  for (int i = 0; i < 3; ++i) {
    rgbe[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::ldexp(c[i], 8 - exponent) + 0.5f);
  }
  rgbe[3] = static_cast<std::uint8_t>(exponent + kBias);
  return rgbe;
}

void put(Bytes& bytes, std::size_t value) { bytes.push_back(static_cast<std::byte>(value)); }

std::size_t run_length(std::span<const Rgbe> row, std::size_t from, std::size_t channel) {
  constexpr std::size_t kLongestRun = 127;
  std::size_t end = from + 1;
  while (end < row.size() && end - from < kLongestRun && row[end][channel] == row[from][channel]) {
    ++end;
  }
  return end - from;
}

void put_channel(Bytes& bytes, std::span<const Rgbe> row, std::size_t channel) {
  constexpr std::size_t kShortestRun = 3;  // shorter ones cost as much as the bytes themselves
  constexpr std::size_t kLongestDump = 128;
  for (std::size_t x = 0; x < row.size();) {
    const std::size_t run = run_length(row, x, channel);
    if (run >= kShortestRun) {
      put(bytes, 128 + run);
      put(bytes, row[x][channel]);
      x += run;
      continue;
    }
    std::size_t end = x + run;
    while (end < row.size() && end - x < kLongestDump &&
           run_length(row, end, channel) < kShortestRun) {
      ++end;
    }
    put(bytes, end - x);
    for (; x < end; ++x) put(bytes, row[x][channel]);
  }
}

std::string header(const Image& image, const Metadata& metadata) {
  std::string text = "#?RADIANCE\n";
  for (const auto& [key, value] : metadata) {
    std::string line = value;
    std::replace(line.begin(), line.end(), '\n', ' ');  // a line break would end the comment
    text += fmt::format("# {}{}={}\n", kKeyPrefix, key, line);
  }
  // Radiance's default primaries are not those of Rec. 709.
  text += "PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n";
  text += "FORMAT=32-bit_rle_rgbe\n\n";
  return text + fmt::format("-Y {} +X {}\n", image.height, image.width);
}

}  // namespace

Bytes encode_hdr(const Image& image, const WriteOptions& options) {
  Bytes bytes;
  for (char c : header(image, options.metadata)) put(bytes, static_cast<unsigned char>(c));
  const auto width = static_cast<std::size_t>(image.width);
  const bool run_coded = width >= 8 && width < 32768;  // the only widths the coding can express
  std::vector<Rgbe> row(width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      row[static_cast<std::size_t>(x)] = to_rgbe(image.at(x, y));
    if (run_coded) {
      for (std::size_t mark : {std::size_t{2}, std::size_t{2}, width >> 8, width & 255}) {
        put(bytes, mark);
      }
      for (std::size_t channel = 0; channel < 4; ++channel) put_channel(bytes, row, channel);
    } else {
      for (const Rgbe& pixel : row) {
        for (std::uint8_t value : pixel) put(bytes, value);
      }
    }
  }
  return bytes;
}

}  // namespace lantern::codec
