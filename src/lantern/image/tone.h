// SPDX-License-Identifier: MIT
// Linear radiance to 8-bit sRGB. Every number has an answer: what is negative or no number becomes
// black, infinity white.
#pragma once

#include "lantern/core/math.h"

#include <array>
#include <cstdint>

namespace lantern {

/// Both curves work on each channel alone. Clipping turns the hue of a bright saturated colour
/// towards the nearest of red, green, blue, cyan, magenta, yellow and white; the filmic curve does
/// it gradually and pales the colour on the way, as film does.
enum class ToneCurve {
  kPlain,   // clip at 1
  kFilmic,  // roll off highlights: 0.18 becomes 0.27, 1 becomes 0.80, white from 7.2 up
            // [Narkowicz 2015, ACES Filmic Tone Mapping Curve], without its optional factor 0.6
};

struct Tone {
  float exposure = 0.0f;  // stops: radiance is multiplied by 2^exposure
  ToneCurve curve = ToneCurve::kPlain;
};

/// sRGB encoding of a linear value in [0, 1] (IEC 61966-2-1), itself in [0, 1]; clips beyond.
float linear_to_srgb(float linear);

/// The inverse.
float srgb_to_linear(float srgb);

/// What a screen shows of the radiance, linear and in [0, 1].
Rgb shown(const Rgb& radiance, const Tone& tone);

/// The same as bytes.
std::array<std::uint8_t, 3> to_srgb8(const Rgb& radiance, const Tone& tone);

}  // namespace lantern
