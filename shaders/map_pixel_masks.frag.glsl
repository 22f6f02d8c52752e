// SPDX-License-Identifier: MIT
// Which lights a pixel sees, from what is known of it and its neighbours of a row.
#include "shaders/colour_quads.glsl"

uniform highp usampler2D u_masks;  // see shaders/map_masks.frag.glsl

layout(location = 0) out vec4 o_mask;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint mask = texelFetch(u_masks, quad_of(pixel), 0)[pixel.x % kColumns];
  o_mask = vec4(uvec4(mask, mask >> 8, mask >> 16, mask >> 24) & 255u) / 255.0;
}
