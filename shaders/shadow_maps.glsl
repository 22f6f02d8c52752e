// SPDX-License-Identifier: MIT
// Where points lie in the shadow maps of up to 32 lights of one KIND (see shaders/lights.glsl).
#include "shaders/octahedral.glsl"
#include "shaders/shadow_map.glsl"
#include "shaders/texel.glsl"

// A row for each light. Mesa looks textures up faster than uniform blocks.
uniform highp sampler2D u_map_frames;
uniform highp usampler2D u_map_blocks;  // see shaders/shadow_map.glsl

// What loops would find anew for each look-up, once begin_maps() was called.
int map_size;
vec2 frame_texel, block_texel;

void begin_maps() {
  map_size = u_map_size;
  frame_texel = texel_size(u_map_frames);
  block_texel = texel_size(u_map_blocks);
}

const int kMapsAcross = 4;

struct LightMap {
  vec4 x, y, z;  // axes of its frame, its position; of KIND 2 what makes (x, y) in [-1, 1] and depth
};

LightMap map_of(int light) {
  return LightMap(texel_of(u_map_frames, frame_texel, ivec2(0, light)),
                  texel_of(u_map_frames, frame_texel, ivec2(1, light)),
                  texel_of(u_map_frames, frame_texel, ivec2(2, light)));
}

/// As long as the light is far; of a directional light a unit vector.
vec3 way_to(LightMap map, vec3 position) {
#if KIND == 2
  return -map.z.xyz;
#else
  return vec3(map.x.w, map.y.w, map.z.w) - position;
#endif
}

/// Where a point lies in a map.
struct MapPoint {
  vec2 texel;    // of the map, whose first one's centre is at a half
  float depth;   // as the map has it
  float reach;   // how far apart what the four texels around see is here, if it faces the light
  float scale;   // how many times as long as a depth of 1 the way to the light is
  float height;  // over the plane of a light that shines to one side
};

MapPoint find_in_map(LightMap map, vec3 position, vec3 way) {
  MapPoint found;
  float across = float(map_size);
#if KIND == 2
  vec2 at = vec2(dot(map.x.xyz, position) + map.x.w, dot(map.y.xyz, position) + map.y.w);
  found.depth = dot(map.z.xyz, position) + map.z.w;
  found.reach = sqrt(1.0 / dot(map.x.xyz, map.x.xyz) + 1.0 / dot(map.y.xyz, map.y.xyz)) *
                (2.0 / across);
  found.scale = 1.0;
  found.height = 1.0;
#else
  vec3 local = -vec3(dot(map.x.xyz, way), dot(map.y.xyz, way), dot(map.z.xyz, way));
#if KIND == 0
  found.depth = max(abs(local.x), abs(local.y)) + local.z;
  vec2 at = local.xy / found.depth;
  // Of the octahedron no step across and up is longer than this many.
  const float kLongest = 1.415;
#else
  found.depth = abs(local.x) + abs(local.y) + abs(local.z);
  vec2 at = local.xy / found.depth;
  if (local.z < 0.0) at = fold(at);
  // A texel across and one up are (1, 1, -2) * 2 / map_size on the octahedron.
  const float kLongest = 2.45;
#endif
  found.scale = found.depth;
  found.height = local.z;
  found.reach = found.depth * (2.0 * kLongest / across);
#endif
  found.texel = (0.5 * at + 0.5) * across;
  return found;
}

/// The corner of a light's map in the texture.
ivec2 corner_of_map(int light) {
  return ivec2(light & (kMapsAcross - 1), light / kMapsAcross) * map_size;
}

/// The first of the four texels around; at the map's border not all of them are in it.
ivec2 block_of(vec2 texel) {
  ivec2 block = ivec2(floor(texel - 0.5));
#if KIND == 0
  // Beyond is nothing to be lit.
  block = clamp(block, ivec2(0), ivec2(map_size - 2));
#endif
  return block;
}

bool is_at_border(ivec2 low, ivec2 high) {
  return min(low.x, low.y) < 0 || max(high.x, high.y) > map_size - 2;
}
