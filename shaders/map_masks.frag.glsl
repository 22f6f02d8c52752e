// SPDX-License-Identifier: MIT
// Which of up to 32 lights a pixel sees of whose tile maps do not tell all: what they tell of the
// four texels around its point and, where that is nothing, rays.
#include "shaders/map_rays.glsl"
#include "shaders/map_told.glsl"

uniform highp usampler2D u_map_blocks;  // see shaders/shadow_map.glsl

layout(location = 0) out vec4 o_mask;

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
  Receiver p = receiver_at(at);
  uvec2 told = told_of(at);
  uint seen = told.x, unknown = told.y, open = 0u;
  do {
    uint bit = lowest(unknown);
    int answer = look_up(number_of(bit), p);
    if (answer == kSeen) seen |= bit;
    if (answer == kOpen) open |= bit;
    unknown ^= bit;
  } while (unknown != 0u);
  if (open != 0u) {
    do {
      uint bit = lowest(open);
      if (sees(number_of(bit), p)) seen |= bit;
      open ^= bit;
    } while (open != 0u);
  }
  o_mask = bytes_of(seen);
}
