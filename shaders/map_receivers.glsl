// SPDX-License-Identifier: MIT
// The points that ask maps which lights they see.
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_points;
// The first triangle that is not in the way and 1, or 0 where nothing is seen; how many, kHasPatch.
uniform highp usampler2D u_receivers;

const uint kHasPatch = 0x80000000u;  // they are all of a patch

struct Receiver {
  vec3 position, geometric;
  uint first, count;  // of the triangles that are not in the way
  uint its_patch;     // which these are, or 0
};

Receiver receiver_at(ivec2 pixel) {
  uvec4 point = texel_of(u_points, pixel);
  uvec2 bits = texel_of(u_receivers, pixel).rg;
  Receiver p;
  p.position = uintBitsToFloat(point.xyz);
  p.geometric = unpack_unit(point.w);
  p.first = bits.x;
  p.count = bits.y & ~kHasPatch;
  p.its_patch = (bits.y & kHasPatch) != 0u ? bits.x : 0u;
  return p;
}
