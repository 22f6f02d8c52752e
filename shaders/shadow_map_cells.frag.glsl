// SPDX-License-Identifier: MIT
// What cells of kCell by kCell blocks of finished maps see.
#include "shaders/shadow_map.glsl"

uniform highp usampler2D u_blocks;

layout(location = 0) out uvec4 o_cell;

void main() {
  ivec2 first = kCell * ivec2(gl_FragCoord.xy);
  uint the_patch = 0u, near = kInfinitelyFar, far = 0u;
  for (int y = 0; y < kCell; ++y) {
    for (int x = 0; x < kCell; ++x) {
      uvec2 sees = texelFetch(u_blocks, first + ivec2(x, y), 0).xy;
      near = min(near, sees.y >> 16);
      far = max(far, sees.y & 0xffffu);
      if (the_patch == 0u) the_patch = sees.x;
      if (sees.x != 0u && sees.x != the_patch) the_patch = kNoPatch;
    }
  }
  o_cell = uvec4(the_patch, (near << 16) | far, 0u, 0u);
}
