// SPDX-License-Identifier: MIT
// Of each tile the mean of its points and their shading normal, packed, if all of it is in one plane
// and shaded as one.
#include "shaders/interleaved_planes.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;

layout(location = 0) out uvec4 o_tile;

uint shading_at(ivec2 at) { return texelFetch(u_reflectances, at, 0).w; }

void main() {
  ivec2 first = TILE * ivec2(gl_FragCoord.xy);
  uvec4 plane = texelFetch(u_points, first, 0);
  bool is_flat = all(lessThanEqual(first + TILE, textureSize(u_points, 0)));
  vec3 sum = vec3(0.0);
  for (int y = 0; y < TILE; ++y) {
    for (int x = 0; x < TILE; ++x) {
      uvec4 point = texelFetch(u_points, first + ivec2(x, y), 0);
      is_flat = is_in_plane(plane, point) && is_flat;
      sum += uintBitsToFloat(point.xyz);
    }
  }
  // Within a plane shading changes steadily: its corners tell.
  uint shading = shading_at(first);
  for (int corner = 1; corner < 4; ++corner) {
    ivec2 at = first + (TILE - 1) * ivec2(corner % 2, corner / 2);
    is_flat = are_parallel(unpack_unit(shading), unpack_unit(shading_at(at))) && is_flat;
  }
  vec3 middle = sum / float(TILE * TILE);
  o_tile = uvec4(floatBitsToUint(middle), is_flat ? shading : kNotFlat);
}
