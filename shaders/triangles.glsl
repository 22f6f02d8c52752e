// SPDX-License-Identifier: MIT
// Texels row by row, as in the textures of triangle_texture.h, whose widths are powers of two: Mesa
// takes long to divide integers.

/// Of positive numbers.
int exponent_of(float number) { return int(floatBitsToUint(number) >> 23) - 127; }

uint lowest(uint bits) { return bits & (~bits + 1u); }
/// The number of a bit; 0 of none.
int number_of(uint bit) { return max(exponent_of(float(bit)), 0); }

ivec2 texel_number(int i, int width) { return ivec2(i & (width - 1), i >> number_of(uint(width))); }

/// A corner of a triangle and the number of the triangle beyond the edge from it to the next and 1,
/// or 0.
vec4 corner_of(highp sampler2D corners, uint triangle, int corner) {
  return texelFetch(corners, texel_number(3 * int(triangle) + corner, textureSize(corners, 0).x), 0);
}
