// SPDX-License-Identifier: MIT
// Texels row by row, as in the textures of triangle_texture.h, whose widths are powers of two: Mesa
// takes long to divide integers.
#include "shaders/bits.glsl"
#include "shaders/texel.glsl"

ivec2 texel_number(int i, int width) { return ivec2(i & (width - 1), i >> number_of(uint(width))); }

/// A corner of a triangle and the number of the triangle beyond the edge from it to the next and 1,
/// or 0.
vec4 corner_of(highp sampler2D corners, uint triangle, int corner) {
  return texel_of(corners, texel_number(3 * int(triangle) + corner, textureSize(corners, 0).x));
}
