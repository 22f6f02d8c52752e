// SPDX-License-Identifier: MIT
// The shares of each row brought together, each by a tent over its two pixels around: what the
// shares of that row of a tile give.
#include "shaders/interleaved_quads.glsl"

uniform highp usampler2D u_joins;
uniform highp usampler2D u_shares;

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy)), tile = at / TILE;
  uint joins = texelFetch(u_joins, tile, 0).r;
  bool before = (joins & kBefore) != 0u, after = (joins & kAfter) != 0u;
  ivec2 share_size = textureSize(u_shares, 0) / TILE;
  o_red = o_green = o_blue = vec4(0.0);
  for (int x = 1 - TILE; x < kColumns + TILE - 1; ++x) {
    ivec2 other = ivec2(within(at.x + x, tile.x, before, after), at.y);
    uvec4 bits = texelFetch(u_shares, (other % TILE) * share_size + other / TILE, 0);
    vec3 irradiance = uintBitsToFloat(bits.rgb);
    vec4 near = vec4(nearness(x), nearness(x - 1), nearness(x - 2), nearness(x - 3));
    o_red += near * irradiance.r;
    o_green += near * irradiance.g;
    o_blue += near * irradiance.b;
  }
}
