// SPDX-License-Identifier: MIT
#include "lantern/image/difference.h"

#include "lantern/image/compare.h"
#include "lantern/image/tone.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

Rgb linear(const Rgb& srgb) {
  return {srgb_to_linear(srgb.r), srgb_to_linear(srgb.g), srgb_to_linear(srgb.b)};
}

// Colours as a screen shows them (sRGB), so that steps between them look even.
const Rgb kSame(1.0f), kBrighter(0.72f, 0.06f, 0.10f), kDarker(0.08f, 0.24f, 0.70f);
const std::array<Rgb, 5> kErrorColours = {Rgb(0.0f), Rgb(0.32f, 0.10f, 0.50f),
                                          Rgb(0.80f, 0.24f, 0.38f), Rgb(0.98f, 0.62f, 0.28f),
                                          Rgb(1.0f, 0.98f, 0.80f)};

Rgb error_colour(float error) {
  constexpr auto kSpans = static_cast<float>(kErrorColours.size() - 1);
  const float place = std::clamp(error, 0.0f, 1.0f) * kSpans;
  const float span = std::min(std::floor(place), kSpans - 1.0f);
  const auto i = static_cast<std::size_t>(span);
  return linear(glm::mix(kErrorColours[i], kErrorColours[i + 1], place - span));
}

}  // namespace

Image difference(const Image& a, const Image& b) {
  require_comparable(a, b);
  Image out(a.width, a.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = a.pixels[i] - b.pixels[i];
  return out;
}

Image paint_difference(const Image& a, const Image& b, float full) {
  assert(full > 0.0f);
  require_comparable(a, b);
  Image out(a.width, a.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const float reference = luminance(b.pixels[i]);
    const float relative = (luminance(a.pixels[i]) - reference) /
                           std::hypot(reference, std::sqrt(static_cast<float>(kRelativeFloor)));
    const float share = std::min(1.0f, std::abs(relative) / full);
    out.pixels[i] = linear(glm::mix(kSame, relative > 0.0f ? kBrighter : kDarker, share));
  }
  return out;
}

Image paint_errors(std::span<const float> errors, int width, int height) {
  Image out(width, height);
  assert(errors.size() == out.pixels.size());
  std::transform(errors.begin(), errors.end(), out.pixels.begin(), error_colour);
  return out;
}

Image grey_errors(std::span<const float> errors, int width, int height) {
  Image out(width, height);
  assert(errors.size() == out.pixels.size());
  std::transform(errors.begin(), errors.end(), out.pixels.begin(), [](float e) { return Rgb(e); });
  return out;
}

}  // namespace lantern
