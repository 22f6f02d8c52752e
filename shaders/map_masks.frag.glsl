// SPDX-License-Identifier: MIT
// Which of up to 32 lights each pixel sees: what maps tell of its tile or, where that is nothing,
// of the four texels around its point.
#include "shaders/map_receivers.glsl"
#include "shaders/map_tiles.glsl"
#include "shaders/shadow_maps.glsl"
#include "shaders/triangles.glsl"

uniform highp usampler2D u_told;  // see shaders/map_tile_masks.frag.glsl
uniform highp usampler2D u_map_blocks;  // see shaders/shadow_map.glsl
uniform sampler2D u_mask;         // lights that are asked for

layout(location = 0) out vec4 o_mask;
layout(location = 1) out uvec4 o_left;  // seen, and left open: 1 of depth, else 0

const int kShadowed = 0;
const int kSeen = 1;
const int kOpen = 2;

/// What the map tells by itself.
int look_up(int light, Receiver p) {
  LightMap map = map_of(light);
  vec3 way = way_to(map, p.position);
  float cosine = dot(p.geometric, way);
  if (cosine <= 0.0) return kShadowed;
  MapPoint at = find_in_map(map, p.position, way);
#if KIND == 0
  if (at.height <= 0.0) return kShadowed;
#endif
  ivec2 block = block_of(at.texel);
  if (is_at_border(block, block)) return kOpen;
  uvec2 sees = texelFetch(u_map_blocks, corner_of_map(light) + block, 0).xy;
  if ((sees.x == p.its_patch || sees.x == 0u) && near_of(sees.y) > at.depth) return kSeen;
  // All is further before the point than the point's own surface comes within the block.
  return (at.depth - far_of(sees.y)) * cosine > at.reach * at.scale ? kShadowed : kOpen;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 bytes = uvec4(texelFetch(u_mask, at, 0) * 255.0 + 0.5);
  uint asked = bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
  uvec2 told = texelFetch(u_told, at / kTile, 0).xy & asked;
  uint seen = told.x, unknown = told.y, open = 0u;
  Receiver p = receiver_at(at);
  // Mesa runs what is in a loop once more than `while` says.
  for (;;) {
    uint bit = lowest(unknown);
    int answer = look_up(number_of(bit), p);
    if (answer == kSeen) seen |= bit;
    if (answer == kOpen) open |= bit;
    unknown ^= bit;
    if (unknown == 0u) break;
  }
  o_mask = bytes_of(seen);
  o_left = uvec4(seen, open, 0u, 0u);
  gl_FragDepth = open != 0u ? 1.0 : 0.0;
}
