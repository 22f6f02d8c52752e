// SPDX-License-Identifier: MIT
// What encloses the points of each group of TILES_IN_GROUP x TILES_IN_GROUP tiles, and their
// normals: see map_tiles.frag.glsl.
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_spheres;
uniform highp usampler2D u_normals;

layout(location = 0) out uvec4 o_sphere;
layout(location = 1) out uvec4 o_normals;

void main() {
  ivec2 first = TILES_IN_GROUP * ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_spheres, 0) - 1;
  const float kFar = 1e30;
  vec3 low = vec3(kFar), high = vec3(-kFar), normals = vec3(0.0);
  uint common_patch = 0u;
  bool is_common = true;
  int i = 0;
  do {
    ivec2 at = min(first + ivec2(i % TILES_IN_GROUP, i / TILES_IN_GROUP), last);
    vec4 sphere = uintBitsToFloat(texel_of(u_spheres, at));
    if (sphere.w < 0.0) continue;
    uvec4 of_tile = texel_of(u_normals, at);
    if (common_patch == 0u) common_patch = of_tile.w;
    is_common = is_common && of_tile.w != 0u && of_tile.w == common_patch;
    low = min(low, sphere.xyz - sphere.w);
    high = max(high, sphere.xyz + sphere.w);
    normals += unpack_unit(of_tile.x);
  } while (++i < TILES_IN_GROUP * TILES_IN_GROUP);
  o_sphere = uvec4(floatBitsToUint(vec4(0.0, 0.0, 0.0, -1.0)));
  o_normals = uvec4(0u);
  if (low.x > high.x) return;
  vec3 centre = 0.5 * (low + high);
  uint packed_normal = pack_unit(normals);
  vec3 normal = unpack_unit(packed_normal);
  float radius = 0.0, thickness = 0.0, spread = 0.0;
  i = 0;
  do {
    ivec2 at = min(first + ivec2(i % TILES_IN_GROUP, i / TILES_IN_GROUP), last);
    vec4 sphere = uintBitsToFloat(texel_of(u_spheres, at));
    if (sphere.w < 0.0) continue;
    uvec4 of_tile = texel_of(u_normals, at);
    vec2 off = uintBitsToFloat(of_tile.yz);
    float turned = length(unpack_unit(of_tile.x) - normal);
    radius = max(radius, length(sphere.xyz - centre) + sphere.w);
    thickness = max(thickness, abs(dot(normal, sphere.xyz - centre)) + off.y + turned * sphere.w);
    spread = max(spread, turned + off.x);
  } while (++i < TILES_IN_GROUP * TILES_IN_GROUP);
  o_sphere = floatBitsToUint(vec4(centre, radius));
  o_normals = uvec4(packed_normal, floatBitsToUint(spread), floatBitsToUint(thickness),
                    is_common ? common_patch : 0u);
}
