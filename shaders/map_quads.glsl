// SPDX-License-Identifier: MIT
// Which of up to 32 lights four pixels of a row see: what maps tell of their tile, then of the four
// texels around each point and, where that is nothing, rays. For texels a light is looked up once
// for the four; a ray is one of any of them, so that neighbours wait less for each other.
#include "shaders/colour_quads.glsl"
#include "shaders/map_rays.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_told;  // see shaders/map_tile_masks.frag.glsl
#if ASKED
uniform sampler2D u_mask;  // the lights that each pixel asks for
#endif

/// What the map tells by itself: bit 0, the light is seen; bit 1, it does not tell.
const uint kShadowed = 0u, kSeen = 1u, kOpen = 2u;

uint look_up(int light, LightMap map, Receiver p) {
  vec3 way = way_to(map, p.position);
  float cosine = dot(p.geometric, way);
  if (cosine <= 0.0) return kShadowed;
  MapPoint at = find_in_map(map, p.position, way);
#if KIND == 0
  if (at.height <= 0.0) return kShadowed;
#endif
  ivec2 block = block_of(at.texel);
  if (is_at_border(block, block)) return kOpen;
  uvec2 sees = texel_of(u_map_blocks, block_texel, corner_of_map(light) + block).xy;
  if ((sees.x == p.its_patch || sees.x == 0u) && near_of(sees.y) > at.depth) return kSeen;
  // All is further before the point than the point's own surface comes within the block.
  return (at.depth - far_of(sees.y)) * cosine > at.reach * at.scale ? kShadowed : kOpen;
}

/// A quad of pixels, and their points.
struct Receivers {
  ivec2 at0, at1, at2, at3;  // in columns beyond the picture the last one
  Receiver p0, p1, p2, p3;
};

Receivers receivers_of(ivec2 quad) {
  ivec2 first = first_pixel_of(quad), last = textureSize(u_points, 0) - 1;
  Receivers r;
  r.at0 = min(first, last);
  r.at1 = min(first + ivec2(1, 0), last);
  r.at2 = min(first + ivec2(2, 0), last);
  r.at3 = min(first + ivec2(3, 0), last);
  r.p0 = receiver_at(r.at0);
  r.p1 = receiver_at(r.at1);
  r.p2 = receiver_at(r.at2);
  r.p3 = receiver_at(r.at3);
  return r;
}

/// Their masks; each has its bits in what it asks for.
uvec4 seen_by(Receivers r) {
  begin_maps();
  begin_rays();
  uvec2 told = texel_of(u_told, r.at0 / TILE).xy;
#if ASKED
  uvec4 asked = uvec4(mask_of(texel_of(u_mask, r.at0)), mask_of(texel_of(u_mask, r.at1)),
                      mask_of(texel_of(u_mask, r.at2)), mask_of(texel_of(u_mask, r.at3)));
#else
  uvec4 asked = uvec4(told.x | told.y);
#endif
  uvec4 seen = told.x & asked, open = uvec4(0u);
  uint unknown = told.y & (asked.x | asked.y | asked.z | asked.w);
  if (unknown != 0u) {
    do {
      uint bit = lowest(unknown);
      int light = number_of(bit);
      LightMap map = map_of(light);
      uvec4 answers = uvec4(look_up(light, map, r.p0), look_up(light, map, r.p1),
                            look_up(light, map, r.p2), look_up(light, map, r.p3));
      seen |= (answers & kSeen) * bit & asked;
      open |= (answers & kOpen) / kOpen * bit & asked;
      unknown ^= bit;
    } while (unknown != 0u);
  }
  if (any(notEqual(open, uvec4(0u)))) {
    do {
      uvec4 bits = uvec4(lowest(open.x), open.x == 0u ? lowest(open.y) : 0u, 0u, 0u);
      if ((open.x | open.y) == 0u) {
        bits.z = lowest(open.z);
        if (open.z == 0u) bits.w = lowest(open.w);
      }
      Receiver p = r.p0;
      if (bits.y != 0u) p = r.p1;
      if (bits.z != 0u) p = r.p2;
      if (bits.w != 0u) p = r.p3;
      uint bit = bits.x | bits.y | bits.z | bits.w;
      if (sees(number_of(bit), p)) seen |= bits;
      open ^= bits;
    } while (any(notEqual(open, uvec4(0u))));
  }
  return seen;
}
