// SPDX-License-Identifier: MIT
// Of each block of 16x16 pixels of an item buffer: the delta form factors of all, and of those that see
// nothing that could take light up.
#include "shaders/hemicube.glsl"
#include "shaders/texel.glsl"

uniform usampler2D items;

layout(location = 0) out vec4 sums;  // all, lost

void main() {
  ivec2 size = textureSize(items, 0);
  ivec2 corner = 16 * ivec2(gl_FragCoord.xy);
  float all = 0.0;
  float lost = 0.0;
  for (int y = corner.y; y < min(corner.y + 16, size.y); ++y) {
    for (int x = corner.x; x < min(corner.x + 16, size.x); ++x) {
      float delta = hemicube_delta(ivec2(x, y), size.x);
      uint item = texel_of(items, ivec2(x, y)).x;
      all += delta;
      if (item == 0u || item >= 0x80000000u) lost += delta;
    }
  }
  sums = vec4(all, lost, 0.0, 0.0);
}
