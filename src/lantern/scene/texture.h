// SPDX-License-Identifier: MIT
// Filtered texture look-ups: linear RGBA out of a Texture and a texture coordinate.
#pragma once

#include "lantern/scene/scene.h"

namespace lantern {

/// Linear value of an 8-bit sRGB channel (IEC 61966-2-1).
float srgb8_to_linear(std::uint8_t value);

/// One texel, linear RGBA; x and y must lie inside.
Vec4 texel(const Texture& texture, int x, int y);

/// Bilinear value at (u, v); texel centres lie at (i + 0.5) / width. Coordinates that are not
/// finite count as 0.
Vec4 sample(const Texture& texture, Vec2 uv);

/// Mean over all texels.
Vec4 mean(const Texture& texture);

}  // namespace lantern
