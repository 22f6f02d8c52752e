// SPDX-License-Identifier: MIT
// What is known of each tile: see shaders/interleaved.glsl.
#include "shaders/interleaved.glsl"
#include "shaders/interleaved_planes.glsl"

uniform highp usampler2D u_tiles;  // see shaders/interleaved_tiles.frag.glsl
uniform highp usampler2D u_shares;

layout(location = 0) out uint o_joins;

bool are_joined(ivec2 tile, ivec2 other) {
  if (any(lessThan(other, ivec2(0)))) return false;
  if (any(greaterThanEqual(other, textureSize(u_tiles, 0)))) return false;
  uvec4 a = texelFetch(u_tiles, tile, 0), b = texelFetch(u_tiles, other, 0);
  return a.w != kNotFlat && b.w != kNotFlat && is_in_plane(a, b);
}

float brightness(ivec2 place) {
  return dot(uintBitsToFloat(texelFetch(u_shares, place, 0).rgb), vec3(1.0));
}

/// How much the shares change from the tile to its neighbours at most, over what they are.
float contrast(ivec2 tile, ivec2 low, ivec2 high) {
  ivec2 size = textureSize(u_tiles, 0);
  vec4 change = vec4(0.0);
  float all_shares = 0.0;
  for (int share = 0; share < TILE * TILE; ++share) {
    ivec2 corner = ivec2(share % TILE, share / TILE) * size;
    float here = brightness(corner + tile);
    change += abs(here - vec4(brightness(corner + ivec2(low.x, tile.y)),
                              brightness(corner + ivec2(high.x, tile.y)),
                              brightness(corner + ivec2(tile.x, low.y)),
                              brightness(corner + ivec2(tile.x, high.y))));
    all_shares += here;
  }
  return max(max(change.x, change.y), max(change.z, change.w)) / max(all_shares, 1e-30);
}

void main() {
  ivec2 tile = ivec2(gl_FragCoord.xy);
  bool before = are_joined(tile, tile - ivec2(1, 0)), after = are_joined(tile, tile + ivec2(1, 0));
  bool above = are_joined(tile, tile - ivec2(0, 1)), below = are_joined(tile, tile + ivec2(0, 1));
  // More than this is an edge of a shadow or something near.
  const float kSmooth = 0.25;
  ivec2 low = tile - ivec2(before, above), high = tile + ivec2(after, below);
  bool is_smooth = (before || after) && (above || below) && contrast(tile, low, high) < kSmooth;
  bool is_sky = texelFetch(u_tiles, tile, 0) == uvec4(0u);
  o_joins = (before ? kBefore : 0u) | (after ? kAfter : 0u) | (above ? kAbove : 0u) |
            (below ? kBelow : 0u) | (is_smooth || is_sky ? 0u : kRough);
}
