// SPDX-License-Identifier: MIT
// Whether points see lights, by maps of the triangles that lights see. Where the four texels around
// a point do not tell, the ray to the light is met with the triangles that they name: edges of
// shadows are those of triangles, not of texels. [Lecocq et al. 2014, Sub-pixel Shadow Mapping]
// After shaders/lights.glsl.
#include "shaders/octahedral.glsl"
#include "shaders/shadow_map.glsl"

struct LightMap {
  vec4 x, y, z;  // axes of its frame; of KIND 2 they make (x, y) in [-1, 1] and depth of a position
};
layout(std140) uniform LightMaps { LightMap u_maps[32]; };
uniform highp usampler2D u_map_texels;
uniform highp sampler2D u_triangles;  // see corner_of()

const int kMapsAcross = 4;

/// Where a point lies in a map.
struct MapPoint {
  ivec2 corner;  // of the map in the texture
  vec2 texel;    // of the map, whose centre is at a half
  float depth;   // as the map has it
  float reach;   // how far apart what the four texels around see is, at this depth, if it faces the light
};

MapPoint find_in_map(int light, Point p, vec3 way) {
  LightMap map = u_maps[light];
  MapPoint found;
  float across = float(u_map_size);
#if KIND == 2
  vec2 at = vec2(dot(map.x.xyz, p.position) + map.x.w, dot(map.y.xyz, p.position) + map.y.w);
  found.depth = dot(map.z.xyz, p.position) + map.z.w;
  found.reach = sqrt(1.0 / dot(map.x.xyz, map.x.xyz) + 1.0 / dot(map.y.xyz, map.y.xyz)) *
                (2.0 / across);
#else
  vec3 local = -vec3(dot(map.x.xyz, way), dot(map.y.xyz, way), dot(map.z.xyz, way));
  found.depth = abs(local.x) + abs(local.y) + abs(local.z);
  vec2 at = local.xy / found.depth;
#if KIND == 0
  // The four texels around must be of this light's half.
  at *= min(1.0, (1.0 - 4.0 / across) / max(abs(at.x) + abs(at.y), 0.5));
#endif
  if (local.z < 0.0) at = fold(at);
  // A texel across and one up are (1, 1, -2) * 2 / u_map_size on the octahedron.
  found.reach = found.depth * (4.9 / across);
#endif
#if KIND == 0
  int tile = light >> 1;
#else
  int tile = light;
#endif
  found.corner = ivec2(tile % kMapsAcross, tile / kMapsAcross) * u_map_size;
  found.texel = (0.5 * at + 0.5) * across;
  return found;
}

/// The first of the four texels around; at the map's border not all of them are in it.
ivec2 block_of(MapPoint at) { return ivec2(floor(at.texel - 0.5)); }

bool is_at_border(ivec2 block) {
  return min(block.x, block.y) < 0 || max(block.x, block.y) > u_map_size - 2;
}

/// Beyond its border an octahedron goes on at the same border, mirrored.
ivec2 wrapped_texel(ivec2 texel) {
  ivec2 inside = clamp(texel, ivec2(0), ivec2(u_map_size - 1));
  if (inside.x != texel.x) return ivec2(inside.x, u_map_size - 1 - inside.y);
  if (inside.y != texel.y) return ivec2(u_map_size - 1 - inside.x, inside.y);
  return inside;
}

const int kShadowed = 0;
const int kSeen = 1;
const int kOpen = 2;

/// What the map tells by itself. `own` is the number of the point's triangle and 1.
int look_up(int light, Point p, vec3 way, uint own) {
  MapPoint at = find_in_map(light, p, way);
  ivec2 first = block_of(at);
  if (is_at_border(first)) return kOpen;
  uvec2 block = texelFetch(u_map_texels, at.corner + first, 0).xy;
  // All that it sees is further before the point than the point's own surface comes within it.
  float before = at.depth - uintBitsToFloat(block.y);
#if KIND != 2
  before *= dot(way, way) / at.depth;  // times the way's length, as is what it is compared with
#endif
  float slope = dot(way, way) / max(dot(p.geometric, way), 1e-6);
  if (before > at.reach * slope) return kShadowed;
  return block.x == own || block.x == 0u ? kSeen : kOpen;
}

/// Each triangle has three texels: a corner, and the number of the triangle beyond the edge from it
/// to the next and 1, or 0.
vec4 corner_of(uint triangle, int corner) {
  int at = 3 * int(triangle) + corner, width = textureSize(u_triangles, 0).x;
  return texelFetch(u_triangles, ivec2(at % width, at / width), 0);
}

const int kNoSteps = 2;  // so many steps from a texel's triangle one goes no further

/// What is left to ask of a light whose map does not tell by itself.
struct Question {
  int texels;      // of the four around the point, the first in the lowest bit; -1: not known yet
  uint triangle;   // and before these this one, unless 0
  int steps;       // that it is away from a texel's
};
Question new_question() { return Question(-1, 0u, 0); }

/// The next triangle of those that may be in the point's way, and whether it is. [Möller & Trumbore
/// 1997] Behind the edge that the ray passes by, a triangle may be that is too slender for texels.
bool is_in_way(inout Question open, int light, Point p, vec3 way, uint own) {
  MapPoint at = find_in_map(light, p, way);
  ivec2 first = block_of(at);
  if (open.texels < 0) {
    open.texels = 15;
    if (!is_at_border(first)) {
      open.texels = 1 | int(texelFetch(u_map_texels, at.corner + first, 0).x >> kOthers) << 1;
    }
  }
  uint number = open.triangle;
  bool is_other_texel = false, is_nearest = false, has_holes = false;
  if (number == 0u) {
    int bit = open.texels & -open.texels;
    int i = bit == 8 ? 3 : bit >> 1;
    ivec2 texel = wrapped_texel(first + ivec2(i & 1, i >> 1));
    uint seen = texelFetch(u_map_texels, at.corner + texel, 0).x;
    number = seen & kNumber;
    // What has holes stops what goes through this very texel.
    is_nearest = texel == ivec2(floor(at.texel));
    has_holes = (seen & kHoles) != 0u;
    is_other_texel = has_holes && !is_nearest;
    open.texels ^= bit;
    open.steps = has_holes ? kNoSteps : 0;
  }
  open.triangle = 0u;
  if (number == own || number == 0u || is_other_texel) return false;
  vec4 a = corner_of(number - 1u, 0), b = corner_of(number - 1u, 1), c = corner_of(number - 1u, 2);
  vec3 ab = b.xyz - a.xyz, ac = c.xyz - a.xyz, from_a = p.position - a.xyz;
  vec3 across = cross(way, ac), turned = cross(from_a, ab);
  float volume = dot(ab, across);
  float v_of_b = dot(from_a, across) / volume, v_of_c = dot(way, turned) / volume;
  float t = dot(ac, turned) / volume;
  float v_of_a = 1.0 - v_of_b - v_of_c;
  // Rays along a shared edge must not slip through: rounding.
  const float kSeam = 1e-5;
  float least = min(v_of_a, min(v_of_b, v_of_c));
  bool is_before = t > 0.0 && (KIND == 2 || t < 1.0);
  if (is_before && least >= -kSeam) return true;
  // A triangle that is more slender than a texel stands for all that is like it around: it stops
  // what goes through its texel, and so does one with holes.
  vec3 bc = ac - ab, doubled_area = cross(ab, ac);
  float longest = max(dot(ab, ab), max(dot(ac, ac), dot(bc, bc)));
  float texel = 0.25 * at.reach;
  bool is_slender = dot(doubled_area, doubled_area) < texel * texel * longest;
  float slope = dot(way, way) / max(dot(p.geometric, way), 1e-6);
  if (is_nearest && (is_slender || has_holes) && -dot(from_a, way) > at.reach * slope) return true;
  if (!is_before) return false;
  if (open.steps < kNoSteps && volume != 0.0) {
    open.triangle = uint(least == v_of_a ? b.w : least == v_of_b ? c.w : a.w);
    ++open.steps;
  }
  return false;
}

bool is_answered(Question open) { return open.texels == 0 && open.triangle == 0u; }
