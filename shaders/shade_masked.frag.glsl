// SPDX-License-Identifier: MIT
// Light for pixels with masks of the lights that they see.
#include "shaders/shade_quad.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_points;
uniform sampler2D u_mask;
uniform int u_count;  // of lights

Point point_at(ivec2 pixel) {
  uvec4 bits = texel_of(u_points, pixel);
  return Point(uintBitsToFloat(bits.xyz), shading_normal_at(pixel), unpack_unit(bits.w));
}

uint mask_at(ivec2 pixel) { return mask_of(texel_of(u_mask, pixel)); }

void main() {
  ivec2 first = first_pixel_of(ivec2(gl_FragCoord.xy)), last = textureSize(u_points, 0) - 1;
  ivec2 at0 = min(first, last), at1 = min(first + ivec2(1, 0), last);
  ivec2 at2 = min(first + ivec2(2, 0), last), at3 = min(first + ivec2(3, 0), last);
  uvec4 masks = uvec4(mask_at(at0), mask_at(at1), mask_at(at2), mask_at(at3));
  shade(point_at(at0), point_at(at1), point_at(at2), point_at(at3), masks & lowest_bits(u_count));
}
