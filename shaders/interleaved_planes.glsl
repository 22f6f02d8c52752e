// SPDX-License-Identifier: MIT
// Points of the G-buffer that lie in one plane.
#include "shaders/octahedral.glsl"

uniform float u_plane_distance;  // as far off is another surface

/// In place of a tile's normal, if it is not flat: no unit vector.
const uint kNotFlat = 0xffffffffu;

bool is_in_plane(uvec4 plane, uvec4 point) {
  if (point == uvec4(0u) || plane == uvec4(0u)) return point == plane;  // the sky
  const float kFlat = 0.999;
  vec3 normal = unpack_unit(plane.w);
  float off = dot(normal, uintBitsToFloat(point.xyz) - uintBitsToFloat(plane.xyz));
  return abs(off) < u_plane_distance && dot(normal, unpack_unit(point.w)) > kFlat;
}
