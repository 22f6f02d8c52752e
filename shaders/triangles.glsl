// SPDX-License-Identifier: MIT
// Texels row by row, as in the textures of triangle_texture.h, whose widths are powers of two: Mesa
// takes long to divide integers.
#include "shaders/bits.glsl"
#include "shaders/texel.glsl"

struct Rows {
  int last, shift;  // of a row's columns, their exponent
  vec2 size;        // of a texel
};

Rows rows_of(ivec2 size) {
  return Rows(size.x - 1, number_of(uint(size.x)), 1.0 / vec2(size));
}

ivec2 texel_number(int i, Rows rows) { return ivec2(i & rows.last, i >> rows.shift); }

/// A corner of a triangle and the number of the triangle beyond the edge from it to the next and 1,
/// or 0; of a veil the share of the rays that it stops.
vec4 corner_of(highp sampler2D corners, Rows rows, uint triangle, int corner) {
  return texel_of(corners, rows.size, texel_number(3 * int(triangle) + corner, rows));
}
