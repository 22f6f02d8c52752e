// SPDX-License-Identifier: MIT
// Of each tile a point and its normal, as in the G-buffer, if all of it is in that plane.
#include "shaders/interleaved_planes.glsl"

uniform highp usampler2D u_points;

layout(location = 0) out uvec4 o_tile;

void main() {
  ivec2 first = TILE * ivec2(gl_FragCoord.xy);
  uvec4 plane = texelFetch(u_points, first, 0);
  bool flat_tile = all(lessThanEqual(first + TILE, textureSize(u_points, 0)));
  for (int y = 0; y < TILE; ++y) {
    for (int x = 0; x < TILE; ++x) {
      flat_tile = is_in_plane(plane, texelFetch(u_points, first + ivec2(x, y), 0)) && flat_tile;
    }
  }
  o_tile = uvec4(plane.xyz, flat_tile ? plane.w : kNotFlat);
}
