// SPDX-License-Identifier: MIT
// Finishes maps: what each block of two by two texels sees.
#include "shaders/shadow_map.glsl"

uniform highp usampler2D u_texels;
uniform bool u_halves;  // two lights a map

layout(location = 0) out uvec2 o_texel;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), in_map = at & (u_map_size - 1);
  int side = off_diamond(in_map);
  const uint kFar = 0x7f000000u;  // further than anything
  uvec2 seen[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = min(in_map + ivec2(i & 1, i >> 1), ivec2(u_map_size - 1));
    seen[i] = texelFetch(u_texels, at - in_map + texel, 0).xy;
    if (u_halves && side * off_diamond(texel) <= 0) seen[i] = seen[0];
    if (seen[i].x == 0u || (seen[i].x & kHoles) != 0u) seen[i].y = kFar;
  }
  uint others = 0u, depth = seen[0].y;
  for (int i = 1; i < 4; ++i) {
    bool is_new = true;
    for (int j = 0; j < i; ++j) is_new = is_new && seen[i].x != seen[j].x;
    is_new = is_new || (seen[i].x & kHoles) != 0u;
    if (is_new) others |= 1u << uint(i - 1);
    depth = max(depth, seen[i].y);  // bits of floats are in their order
  }
  o_texel = uvec2(seen[0].x | (others << kOthers), depth);
}
