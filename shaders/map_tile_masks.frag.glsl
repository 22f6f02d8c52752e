// SPDX-License-Identifier: MIT
// What maps tell of all points of a tile at once, or with GROUPS of a group of tiles: bit i of two
// masks for light i.
#include "shaders/bits.glsl"
#include "shaders/shadow_maps.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_spheres;  // see shaders/map_tiles.frag.glsl
uniform highp usampler2D u_normals;
#if GROUPS
uniform int u_count;  // of lights
#else
uniform highp usampler2D u_told;  // of groups
#endif

layout(location = 0) out uvec4 o_told;  // seen by all points that face it; each point must ask

const int kShadowed = 0;
const int kSeen = 1;
const int kOpen = 2;

/// How far the nearest that some windows see is that is not of the tile's patch, and the furthest.
struct Sees {
  float near, far;
};

void add(uvec2 window, uint own, inout Sees sees) {
  sees.near = min(sees.near, window.x == own || window.x == 0u ? near_of(window.y) : 0.0);
  sees.far = max(sees.far, far_of(window.y));
}

/// What the texels from one to another see, by two windows a side of a level where that suffices.
Sees look(int light, ivec2 low, ivec2 high, int level, uint own) {
  ivec2 first = min(low >> level, (map_size >> level) - 2);
  ivec2 last = max(first, (high >> level) - 1);
  ivec2 size = ivec2(map_size * kMapsAcross, textureSize(u_map_blocks, 0).y);
  ivec2 corner = corner_of_level(level, size) + (corner_of_map(light) >> level);
  first += corner;
  last += corner;
  Sees sees = Sees(uintBitsToFloat(kInfinitelyFar << 16), 0.0);
  add(texel_of(u_map_blocks, block_texel, first).xy, own, sees);
  add(texel_of(u_map_blocks, block_texel, last).xy, own, sees);
  add(texel_of(u_map_blocks, block_texel, ivec2(first.x, last.y)).xy, own, sees);
  add(texel_of(u_map_blocks, block_texel, ivec2(last.x, first.y)).xy, own, sees);
  return sees;
}

int told(int light, vec4 sphere, vec3 normal, float spread, float thickness, uint own) {
  LightMap map = map_of(light);
  vec3 way = way_to(map, sphere.xyz);
  float cosine = dot(normal, way);
#if KIND == 2
  float slack = spread, most = sphere.w;
#else
  // Depths are sums of coordinates.
  float slack = thickness + spread * (length(way) + sphere.w), most = sqrt(3.0) * sphere.w;
#endif
  if (cosine + slack <= 0.0) return kShadowed;
  MapPoint at = find_in_map(map, sphere.xyz, way);
#if KIND == 2
  vec2 reach = sphere.w * float(map_size) * 0.5 * vec2(length(map.x.xyz), length(map.y.xyz));
#else
#if KIND == 0
  // How far points reach over the light's plane. What gives less than a millionth of what it could
  // from there lies in one plane with the tile.
  float over = at.height + length(cross(map.z.xyz, normal)) * sphere.w + thickness;
  if (over <= 0.0 || (cosine + slack) * over < 1e-6 * dot(way, way)) return kShadowed;
#endif
  if (at.depth < 2.0 * most) return kOpen;
  float part = sphere.w / (at.depth - most);
#if KIND == 0
  // By so much the lesser of the coordinates over depth changes, where all of the sphere has less
  // than this; the larger one changes by sqrt(2) at most.
  vec2 off = abs(2.0 * at.texel / float(map_size) - 1.0);
  float lesser = min(off.x, off.y) + 2.3 * part;
  float change = sqrt(2.0 + 3.0 * lesser * lesser);
#else
  float change = sqrt(2.0);
#endif
  vec2 reach = vec2(0.5 * float(map_size) * change * part);
#endif
  ivec2 low = block_of(at.texel - reach), high = block_of(at.texel + reach) + 1;
  if (is_at_border(low, high - 1)) return kOpen;
  // Two windows of two steps each, wherever the first of them begins, go three steps further.
  int steps = max(high.x - low.x, high.y - low.y);
  if (steps > 3 << (kMapLevels - 1)) return kOpen;
  int level = max(exponent_of(0.3333 * float(steps)) + 1, 0);
  Sees sees = look(light, low, high, level, own);
  if (sees.near > at.depth + most) return kSeen;
  float before = at.depth - most - sees.far;
  float own_reach = (1.0 + max(reach.x, reach.y)) * at.reach * at.scale;
  if (before * max(cosine - slack, 0.0) > own_reach) return kShadowed;
  return kOpen;
}

void main() {
  begin_maps();
  ivec2 tile = ivec2(gl_FragCoord.xy);
  vec4 sphere = uintBitsToFloat(texel_of(u_spheres, tile));
  o_told = uvec4(0u);
  if (sphere.w < 0.0) return;
  uvec4 normals = texel_of(u_normals, tile);
  vec3 normal = unpack_unit(normals.x);
  vec2 off = uintBitsToFloat(normals.yz);
#if GROUPS
  uint seen = 0u, unknown = lowest_bits(u_count);
#else
  uvec2 before = texel_of(u_told, tile / TILES_IN_GROUP).xy;
  uint seen = before.x, unknown = before.y;
#endif
  uint open = 0u;
  do {
    uint bit = lowest(unknown);
    int answer = told(number_of(bit), sphere, normal, off.x, off.y, normals.w);
    if (answer == kSeen) seen |= bit;
    if (answer == kOpen) open |= bit;
    unknown ^= bit;
  } while (unknown != 0u);
  o_told = uvec4(seen, open, 0u, 0u);
}
