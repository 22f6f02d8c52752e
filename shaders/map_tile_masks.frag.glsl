// SPDX-License-Identifier: MIT
// What maps tell of all points of a tile at once: bit i of two masks for light i.
#include "shaders/map_tiles.glsl"
#include "shaders/shadow_maps.glsl"

uniform highp usampler2D u_spheres;  // see shaders/map_tiles.frag.glsl
uniform highp usampler2D u_normals;
uniform highp usampler2D u_map_cells;
uniform int u_count;

layout(location = 0) out uvec4 o_told;  // seen by all points that face it; each point must ask

const int kShadowed = 0;
const int kSeen = 1;
const int kOpen = 2;

// So many texels around a point blocks are asked one by one, and so many cells.
const float kFine = 2.0, kFurthest = 4.0;

/// How far the nearest that some blocks see is that is not of the tile's patch, and the furthest.
struct Sees {
  float near, far;
};

void add(uvec2 block, uint own, inout Sees sees) {
  sees.near = min(sees.near, block.x == own || block.x == 0u ? near_of(block.y) : 0.0);
  sees.far = max(sees.far, far_of(block.y));
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
  MapPoint at = find_in_map(light, map, sphere.xyz, way);
#if KIND == 2
  vec2 reach = sphere.w * float(u_map_size) * 0.5 * vec2(length(map.x.xyz), length(map.y.xyz));
#else
#if KIND == 0
  if (at.height * at.depth + sphere.w <= 0.0) return kShadowed;
#endif
  if (at.depth < 2.0 * most) return kOpen;
  // Coordinates over depth change by up to sqrt(2) over depth.
  float part = sqrt(2.0) * sphere.w / (at.depth - most);
  vec2 reach = vec2(0.5 * float(u_map_size) * part);
#if KIND == 0
  // Of this light's half.
  if (at.height < 2.0 * part + 8.0 / float(u_map_size)) return kOpen;
#endif
#endif
  float texels = max(reach.x, reach.y);
  if (texels > kFurthest) return kOpen;
  ivec2 low = block_of(at.texel - reach), high = block_of(at.texel + reach);
  if (is_at_border(low, high)) return kOpen;
  ivec2 corner = corner_of_map(light);
  Sees sees = Sees(uintBitsToFloat(kInfinitelyFar << 16), 0.0);
  if (texels <= kFine) {
    // Blocks are two texels wide.
    for (int y = low.y; y <= high.y + 1; y += 2) {
      for (int x = low.x; x <= high.x + 1; x += 2) {
        ivec2 block = corner + min(ivec2(x, y), high);
        add(texelFetch(u_map_blocks, block, 0).xy, own, sees);
      }
    }
  } else {
    low = (corner + low) / kCell, high = (corner + high) / kCell;
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        add(texelFetch(u_map_cells, ivec2(x, y), 0).xy, own, sees);
      }
    }
  }
  if (sees.near > at.depth + most) return kSeen;
  float before = at.depth - most - sees.far, own_reach = (1.0 + texels) * at.reach * at.scale;
  if (before * max(cosine - slack, 0.0) > own_reach) return kShadowed;
  return kOpen;
}

void main() {
  ivec2 tile = ivec2(gl_FragCoord.xy);
  vec4 sphere = uintBitsToFloat(texelFetch(u_spheres, tile, 0));
  o_told = uvec4(0u);
  if (sphere.w < 0.0) return;
  uvec4 normals = texelFetch(u_normals, tile, 0);
  vec3 normal = unpack_unit(normals.x);
  vec2 off = uintBitsToFloat(normals.yz);
  uint seen = 0u, open = 0u;
  for (int i = 0; i < u_count; ++i) {
    int answer = told(i, sphere, normal, off.x, off.y, normals.w);
    if (answer == kSeen) seen |= 1u << uint(i);
    if (answer == kOpen) open |= 1u << uint(i);
  }
  o_told = uvec4(seen, open, 0u, 0u);
}
