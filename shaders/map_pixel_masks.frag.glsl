// SPDX-License-Identifier: MIT
// Which lights a pixel sees, from what is known of it and its neighbours of a row.
#include "shaders/bits.glsl"
#include "shaders/colour_quads.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_masks;  // see shaders/map_masks.frag.glsl

layout(location = 0) out vec4 o_mask;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint mask = texel_of(u_masks, quad_of(pixel))[pixel.x % kColumns];
  o_mask = bytes_of(mask);
}
