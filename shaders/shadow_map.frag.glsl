// SPDX-License-Identifier: MIT
// Which triangle a light sees through a texel of its map, how far it is, and its patch.
#include "shaders/shadow_map.glsl"
#if HOLES
#include "shaders/opacity.glsl"
in vec2 v_texcoord;
in float v_alpha;
#endif

in float v_depth;
flat in uint v_triangle;
flat in uint v_patch;

uniform int u_side;  // 1: inside the diamond alone, -1: outside, 0: all of the map
uniform int u_on;    // and, if 0, on it

layout(location = 0) out uvec4 o_texel;

void main() {
  if (u_side * off_diamond(ivec2(gl_FragCoord.xy)) > u_on) discard;
  uint number = v_triangle + 1u;
#if HOLES
  if (is_hole(v_triangle, ivec2(gl_FragCoord.xy), v_texcoord, v_alpha)) discard;
  number |= kHoles;
#endif
  o_texel = uvec4(number, floatBitsToUint(v_depth), v_patch, 0u);
}
