// SPDX-License-Identifier: MIT
// Of each tile the mean of its points and their shading normal, packed, if all of it is in one
// plane.
#include "shaders/interleaved_planes.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;

layout(location = 0) out uvec4 o_tile;

/// With its shading normal: facets of what is smooth are one surface.
uvec4 point_at(ivec2 at) {
  return uvec4(texel_of(u_points, at).xyz, texel_of(u_reflectances, at).w);
}

void main() {
  ivec2 first = TILE * ivec2(gl_FragCoord.xy);
  uvec4 plane = point_at(first);
  bool is_flat = all(lessThanEqual(first + TILE, textureSize(u_points, 0)));
  vec3 sum = vec3(0.0);
  for (int y = 0; y < TILE; ++y) {
    for (int x = 0; x < TILE; ++x) {
      uvec4 point = point_at(first + ivec2(x, y));
      is_flat = is_in_plane(plane, point) && is_flat;
      sum += uintBitsToFloat(point.xyz);
    }
  }
  vec3 middle = sum / float(TILE * TILE);
  o_tile = uvec4(floatBitsToUint(middle), is_flat ? plane.w : kNotFlat);
}
