// SPDX-License-Identifier: MIT
// What the windows of a level of finished maps see, by those of the level before.
#include "shaders/shadow_map.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_windows;

layout(location = 0) out uvec4 o_window;

void main() {
  ivec2 first = 2 * ivec2(gl_FragCoord.xy), last = textureSize(u_windows, 0) - 1;
  uint the_patch = 0u, near = kInfinitelyFar, far = 0u;
  for (int i = 0; i < 4; ++i) {
    // A window begins in the middle of the one before it.
    uvec2 sees = texel_of(u_windows, min(first + 2 * ivec2(i & 1, i >> 1), last)).xy;
    near = min(near, sees.y >> 16);
    far = max(far, sees.y & 0xffffu);
    if (the_patch == 0u) the_patch = sees.x;
    if (sees.x != 0u && sees.x != the_patch) the_patch = kNoPatch;
  }
  o_window = uvec4(the_patch, (near << 16) | far, 0u, 0u);
}
