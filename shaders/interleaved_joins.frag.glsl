// SPDX-License-Identifier: MIT
// Which neighbours of each tile are parts of the same plane: see shaders/interleaved.glsl.
#include "shaders/interleaved.glsl"
#include "shaders/interleaved_planes.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_tiles;  // see shaders/interleaved_tiles.frag.glsl

layout(location = 0) out uint o_joins;

bool are_joined(uvec4 tile, ivec2 other) {
  if (any(lessThan(other, ivec2(0)))) return false;
  if (any(greaterThanEqual(other, textureSize(u_tiles, 0)))) return false;
  uvec4 plane = texel_of(u_tiles, other);
  return tile.w != kNotFlat && plane.w != kNotFlat && is_in_plane(tile, plane);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 tile = texel_of(u_tiles, at);
  o_joins = (are_joined(tile, at - ivec2(1, 0)) ? kBefore : 0u) |
            (are_joined(tile, at + ivec2(1, 0)) ? kAfter : 0u) |
            (are_joined(tile, at - ivec2(0, 1)) ? kAbove : 0u) |
            (are_joined(tile, at + ivec2(0, 1)) ? kBelow : 0u);
}
