// SPDX-License-Identifier: MIT
// Unit vectors in 32 bits: the octahedron folded into a square of 2^16 steps a side; the error is
// below 5e-5 rad. [Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit
// Vectors]
vec2 fold(vec2 v) {
  return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

uint pack_unit(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) p = fold(p);
  uvec2 steps = uvec2(clamp(floor((0.5 * p + 0.5) * 65534.0 + 0.5), 0.0, 65534.0));
  return steps.x | (steps.y << 16);
}

vec3 unpack_unit(uint bits) {
  vec2 p = vec2(float(bits & 0xffffu), float(bits >> 16)) * (2.0 / 65534.0) - 1.0;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = fold(n.xy);
  return normalize(n);
}
