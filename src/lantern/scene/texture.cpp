// SPDX-License-Identifier: MIT
#include "lantern/scene/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

std::array<float, 256> make_srgb_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double encoded = static_cast<double>(i) / 255.0;
    table[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92
                                                     : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return table;
}

const std::array<float, 256> kSrgbTable = make_srgb_table();

int wrap(int i, int size, Wrap mode) {
  switch (mode) {
    case Wrap::kClamp:
      return std::clamp(i, 0, size - 1);
    case Wrap::kMirror: {
      const int period = 2 * size;
      const int m = ((i % period) + period) % period;
      return m < size ? m : period - 1 - m;
    }
    case Wrap::kRepeat:
      break;
  }
  return ((i % size) + size) % size;
}

/// Position in texels, kept where int arithmetic is exact however wild the coordinate is.
float texel_position(float coordinate, int size, Wrap mode) {
  if (!std::isfinite(coordinate)) return -0.5f;
  constexpr float kPeriod = 2.0f;  // a whole number of repeats and of mirrors
  const float inside =
      mode == Wrap::kClamp ? std::clamp(coordinate, 0.0f, 1.0f) : std::fmod(coordinate, kPeriod);
  return inside * static_cast<float>(size) - 0.5f;
}

}  // namespace

float srgb8_to_linear(std::uint8_t value) { return kSrgbTable[value]; }

Vec4 texel(const Texture& texture, int x, int y) {
  assert(x >= 0 && x < texture.width && y >= 0 && y < texture.height);
  const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) +
                             static_cast<std::size_t>(x));
  if (!texture.linear.empty()) {
    const float* t = &texture.linear[i];
    return {t[0], t[1], t[2], t[3]};
  }
  const std::uint8_t* t = &texture.srgb8[i];
  return {kSrgbTable[t[0]], kSrgbTable[t[1]], kSrgbTable[t[2]],
          static_cast<float>(t[3]) * (1.0f / 255.0f)};
}

Vec4 sample(const Texture& texture, Vec2 uv) {
  const float x = texel_position(uv.x, texture.width, texture.wrap_u);
  const float y = texel_position(uv.y, texture.height, texture.wrap_v);
  const float x_floor = std::floor(x), y_floor = std::floor(y);
  const int x0 = wrap(static_cast<int>(x_floor), texture.width, texture.wrap_u);
  const int x1 = wrap(static_cast<int>(x_floor) + 1, texture.width, texture.wrap_u);
  const int y0 = wrap(static_cast<int>(y_floor), texture.height, texture.wrap_v);
  const int y1 = wrap(static_cast<int>(y_floor) + 1, texture.height, texture.wrap_v);
  return glm::mix(glm::mix(texel(texture, x0, y0), texel(texture, x1, y0), x - x_floor),
                  glm::mix(texel(texture, x0, y1), texel(texture, x1, y1), x - x_floor),
                  y - y_floor);
}

Vec4 mean(const Texture& texture) {
  glm::dvec4 sum(0.0);
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) sum += glm::dvec4(texel(texture, x, y));
  }
  return Vec4(sum / (static_cast<double>(texture.width) * texture.height));
}

}  // namespace lantern
