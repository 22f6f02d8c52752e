// SPDX-License-Identifier: MIT
// Finishes maps: what each texel sees, and each block of two by two.
#include "shaders/shadow_map.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_texels;  // of this map alone
uniform highp usampler2D u_others;  // edges before that, or what is behind veils
uniform ivec2 u_first;  // where it will be

layout(location = 0) out uvec4 o_block;
layout(location = 1) out uvec4 o_number;

void main() {
  ivec2 in_map = ivec2(gl_FragCoord.xy) - u_first;
  uvec3 seen[8];  // number, depth, patch: of texels, then of others
  uint nearest = 0xffffffffu, far = 0u, first = 0u;
  for (int i = 0; i < 8; ++i) {
    ivec2 texel = min(in_map + ivec2(i & 1, i >> 1 & 1), ivec2(u_map_size - 1));
    seen[i] = i < 4 ? texel_of(u_texels, texel).xyz : texel_of(u_others, texel).xyz;
    if (seen[i].x == 0u) seen[i].yz = uvec2(kInfinitelyFar << 16, 0u);
    bool has_holes = (seen[i].x & kHoles) != 0u;
    // Floats' bits are in their order. An edge hides no texel.
    if (i < 4) far = max(far, has_holes ? kInfinitelyFar << 16 : seen[i].y);
    if (has_holes) seen[i].yz = uvec2(0u, kNoPatch);
    if (seen[i].y < nearest) {
      nearest = seen[i].y;
      first = seen[i].z;
    }
  }
  uint beyond = kInfinitelyFar << 16;
  for (int i = 0; i < 8; ++i) {
    if (seen[i].z != first) beyond = min(beyond, seen[i].y);
  }
  o_block = uvec4(first, (beyond & 0xffff0000u) | ((far + 0xffffu) >> 16), 0u, 0u);
  o_number = uvec4(seen[0].x, seen[4].x, 0u, 0u);
}
