// SPDX-License-Identifier: MIT
// The points that ask maps which lights they see.
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform highp usampler2D u_owners;  // see shaders/map_owners.frag.glsl

struct Receiver {
  vec3 position, geometric;
  uvec3 owner;
};

Receiver receiver_at(ivec2 pixel) {
  Receiver p;
  p.position = uintBitsToFloat(texelFetch(u_points, pixel, 0).xyz);
  p.geometric = unpack_unit(texelFetch(u_reflectances, pixel, 0).w);
  p.owner = texelFetch(u_owners, pixel, 0).xyz;
  return p;
}

vec4 bytes_of(uint mask) {
  return vec4(uvec4(mask, mask >> 8, mask >> 16, mask >> 24) & 255u) / 255.0;
}
