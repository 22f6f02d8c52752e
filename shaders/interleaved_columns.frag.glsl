// SPDX-License-Identifier: MIT
// Irradiance where the surface is flat: rows brought together as the shares of each were.
#include "shaders/interleaved.glsl"

uniform sampler2D u_red, u_green, u_blue;

layout(location = 0) out vec4 o_red;
layout(location = 1) out vec4 o_green;
layout(location = 2) out vec4 o_blue;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), tile = ivec2(kColumns, 1) * at / TILE;
  if (texelFetch(u_tiles, tile, 0).w == kRough) discard;
  bool before = are_joined(tile, tile - ivec2(0, 1)), after = are_joined(tile, tile + ivec2(0, 1));
  o_red = o_green = o_blue = vec4(0.0);
  for (int y = 1 - TILE; y < TILE; ++y) {
    ivec2 other = ivec2(at.x, within(at.y + y, tile.y, before, after));
    o_red += nearness(y) * texelFetch(u_red, other, 0);
    o_green += nearness(y) * texelFetch(u_green, other, 0);
    o_blue += nearness(y) * texelFetch(u_blue, other, 0);
  }
}
