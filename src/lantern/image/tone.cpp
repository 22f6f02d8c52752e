// SPDX-License-Identifier: MIT
#include "lantern/image/tone.h"

#include <cmath>

namespace lantern {
namespace {

/// NaN goes to 0: every comparison with it is false.
float clip(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

/// [Narkowicz 2015]. Beyond kWhite the fit stays above 1, and at infinity it would be no number.
float filmic(float x) {
  constexpr float kWhite = 100.0f;
  if (!(x > 0.0f)) return 0.0f;
  if (x > kWhite) return 1.0f;
  return (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
}

}  // namespace

float linear_to_srgb(float linear) {
  const float x = clip(linear);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

float srgb_to_linear(float srgb) {
  const float x = clip(srgb);
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

Rgb shown(const Rgb& radiance, const Tone& tone) {
  const float scale = std::exp2(tone.exposure);
  Rgb linear;
  for (int c = 0; c < 3; ++c) {
    const float exposed = scale * radiance[c];
    linear[c] = clip(tone.curve == ToneCurve::kFilmic ? filmic(exposed) : exposed);
  }
  return linear;
}

std::array<std::uint8_t, 3> to_srgb8(const Rgb& radiance, const Tone& tone) {
  const Rgb linear = shown(radiance, tone);
  std::array<std::uint8_t, 3> bytes;
  for (int c = 0; c < 3; ++c) {
    bytes[static_cast<std::size_t>(c)] =
        static_cast<std::uint8_t>(255.0f * linear_to_srgb(linear[c]) + 0.5f);
  }
  return bytes;
}

}  // namespace lantern
