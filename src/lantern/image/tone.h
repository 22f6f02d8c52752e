// SPDX-License-Identifier: MIT
// Linear radiance to 8-bit sRGB.
#pragma once

#include "lantern/core/math.h"

#include <array>
#include <cstdint>

namespace lantern {

enum class ToneCurve {
  kPlain,   // clip at 1
  kFilmic,  // roll off highlights
};

struct Tone {
  float exposure = 0.0f;  // stops: radiance is multiplied by 2^exposure
  ToneCurve curve = ToneCurve::kPlain;
};

/// sRGB encoding of a linear value in [0, 1] (IEC 61966-2-1), itself in [0, 1].
float linear_to_srgb(float linear);

std::array<std::uint8_t, 3> to_srgb8(const Rgb& radiance, const Tone& tone);

}  // namespace lantern
