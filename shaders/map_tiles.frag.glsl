// SPDX-License-Identifier: MIT
// What encloses the points of each tile of pixels, and their normals.
#include "shaders/map_tiles.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform highp usampler2D u_owners;
uniform sampler2D u_emissions;

layout(location = 0) out uvec4 o_sphere;  // bits of floats: centre, radius
// A unit vector; how far others are from it, how far points are off its plane through the centre, as
// bits of floats; their patch, or 0.
layout(location = 1) out uvec4 o_normals;

void main() {
  ivec2 first = kTile * ivec2(gl_FragCoord.xy);
  ivec2 end = min(first + kTile, textureSize(u_points, 0));
  const float kFar = 1e30;
  vec3 low = vec3(kFar), high = vec3(-kFar), normals = vec3(0.0);
  uint common_patch = 0u;
  bool is_common = true;
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      ivec2 at = ivec2(x, y);
      if (texelFetch(u_emissions, at, 0).a == 0.0) continue;
      vec3 position = uintBitsToFloat(texelFetch(u_points, at, 0).xyz);
      uint its_patch = texelFetch(u_owners, at, 0).z;
      if (common_patch == 0u) common_patch = its_patch;
      is_common = is_common && its_patch != 0u && its_patch == common_patch;
      low = min(low, position);
      high = max(high, position);
      normals += unpack_unit(texelFetch(u_reflectances, at, 0).w);
    }
  }
  o_sphere = uvec4(floatBitsToUint(vec4(0.0, 0.0, 0.0, -1.0)));
  o_normals = uvec4(0u);
  if (low.x > high.x) return;
  vec3 centre = 0.5 * (low + high);
  uint packed_normal = pack_unit(normals);
  vec3 normal = unpack_unit(packed_normal);
  float radius = 0.0, thickness = 0.0, spread = 0.0;
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      ivec2 at = ivec2(x, y);
      if (texelFetch(u_emissions, at, 0).a == 0.0) continue;
      vec3 off = uintBitsToFloat(texelFetch(u_points, at, 0).xyz) - centre;
      radius = max(radius, length(off));
      thickness = max(thickness, abs(dot(normal, off)));
      spread = max(spread, length(unpack_unit(texelFetch(u_reflectances, at, 0).w) - normal));
    }
  }
  o_sphere = floatBitsToUint(vec4(centre, radius));
  o_normals = uvec4(packed_normal, floatBitsToUint(spread), floatBitsToUint(thickness),
                    is_common ? common_patch : 0u);
}
