// SPDX-License-Identifier: MIT
// Which triangle a light sees through a texel of its map, how far it is, and its patch.
#include "shaders/shadow_map.glsl"
#if HOLES
#include "shaders/opacity.glsl"
#include "shaders/texel.glsl"
in vec2 v_texcoord;
in float v_alpha;
flat in float v_is_slender;
#endif

in float v_depth;
flat in uint v_triangle;
flat in uint v_patch;

uniform vec3 u_edges[2];  // the face's; see MapFace
#if HOLES
uniform bool u_is_veil;
// What is behind that is drawn: what stops the texel's ray there.
uniform bool u_is_behind;
uniform highp usampler2D u_before;
#endif

layout(location = 0) out uvec4 o_texel;

void main() {
  vec3 off = vec3(off_centre(ivec2(gl_FragCoord.xy)), u_map_size);
  if (min(dot(u_edges[0], off), dot(u_edges[1], off)) < 0.0) discard;
  uint number = v_triangle + 1u;
#if HOLES
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint before = texel_of(u_before, texel).x;
  if (u_is_behind && ((before & kVeil) == 0u || (before & kNumber) == number)) discard;
  bool is_met = u_is_veil && v_is_slender == 0.0 && !u_is_behind;
  if (is_met ? u_opacity <= 0.0 : is_hole(v_triangle, texel, v_texcoord, v_alpha)) discard;
  number |= is_met ? kHoles | kVeil : kHoles;
#endif
  o_texel = uvec4(number, floatBitsToUint(v_depth), v_patch, 0u);
}
