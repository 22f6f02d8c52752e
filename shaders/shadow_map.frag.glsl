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

uniform vec3 u_edges[2];  // the face's; see MapFace

layout(location = 0) out uvec4 o_texel;

void main() {
  vec3 off = vec3(off_centre(ivec2(gl_FragCoord.xy)), u_map_size);
  if (min(dot(u_edges[0], off), dot(u_edges[1], off)) < 0.0) discard;
  uint number = v_triangle + 1u;
#if HOLES
  if (is_hole(v_triangle, ivec2(gl_FragCoord.xy), v_texcoord, v_alpha)) discard;
  number |= kHoles;
#endif
  o_texel = uvec4(number, floatBitsToUint(v_depth), v_patch, 0u);
}
