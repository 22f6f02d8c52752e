// SPDX-License-Identifier: MIT
// The irradiance in the middle of each tile by all lights, and whether it is rough.
#include "shaders/interleaved.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_tiles;  // see shaders/interleaved_tiles.frag.glsl
uniform highp usampler2D u_joins;
uniform sampler2D u_red, u_green, u_blue, u_changes;  // of four tiles of a row

layout(location = 0) out uvec4 o_middle;  // irradiance's bits, what is known of the tile

vec3 irradiance_of(ivec2 tile) {
  ivec2 quad = ivec2(tile.x / 4, tile.y);
  int i = tile.x % 4;
  return vec3(texel_of(u_red, quad)[i], texel_of(u_green, quad)[i],
              texel_of(u_blue, quad)[i]);
}

/// How much a neighbour is brighter or darker, if it is one.
float step_to(ivec2 tile, bool is_joined, float here) {
  return is_joined ? abs(dot(irradiance_of(tile), vec3(1.0)) - here) : 0.0;
}

void main() {
  ivec2 tile = ivec2(gl_FragCoord.xy);
  uint joins = texel_of(u_joins, tile).r;
  bool before = (joins & kBefore) != 0u, after = (joins & kAfter) != 0u;
  bool above = (joins & kAbove) != 0u, below = (joins & kBelow) != 0u;
  vec3 irradiance = irradiance_of(tile);
  float here = dot(irradiance, vec3(1.0));
  float most = max(max(step_to(tile - ivec2(1, 0), before, here),
                       step_to(tile + ivec2(1, 0), after, here)),
                   max(step_to(tile - ivec2(0, 1), above, here),
                       step_to(tile + ivec2(0, 1), below, here)));
  float change = texel_of(u_changes, ivec2(tile.x / 4, tile.y))[tile.x % 4];
  // More than these is something near, or an edge of a shadow.
  const float kMostStep = 0.3, kMostChange = 0.11;
  bool is_smooth = (before || after) && (above || below) && most <= kMostStep * here &&
                   change <= kMostChange * here;
  const uint kBothSides = kBefore | kAfter, kAll = kBothSides | kAbove | kBelow;
  bool is_amid = joins == kAll;
  if (is_amid) {
    uint next = texel_of(u_joins, tile - ivec2(0, 1)).r &
                texel_of(u_joins, tile + ivec2(0, 1)).r;
    is_amid = (next & kBothSides) == kBothSides;
  }
  bool is_sky = texel_of(u_tiles, tile) == uvec4(0u);
  o_middle = uvec4(floatBitsToUint(irradiance), joins | (is_smooth || is_sky ? 0u : kRough) |
                                                    (is_amid ? kAmidPlane : 0u));
}
