// SPDX-License-Identifier: MIT
// Irradiance where the surface is smooth: rows brought together as the shares of each were.
#include "shaders/interleaved_quads.glsl"

uniform highp usampler2D u_joins;
uniform sampler2D u_red, u_green, u_blue;

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy)), tile = at / TILE;
  uint joins = texelFetch(u_joins, tile, 0).r;
  if ((joins & kRough) != 0u) discard;
  bool above = (joins & kAbove) != 0u, below = (joins & kBelow) != 0u;
  o_red = o_green = o_blue = vec4(0.0);
  for (int y = 1 - TILE; y < TILE; ++y) {
    ivec2 other = quad_of(ivec2(at.x, within(at.y + y, tile.y, above, below)));
    o_red += nearness(y) * texelFetch(u_red, other, 0);
    o_green += nearness(y) * texelFetch(u_green, other, 0);
    o_blue += nearness(y) * texelFetch(u_blue, other, 0);
  }
}
