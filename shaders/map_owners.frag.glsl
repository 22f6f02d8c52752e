// SPDX-License-Identifier: MIT
// Which triangles cannot be in the way of any light that a pixel faces: its own one or, on their
// outer side, all of its convex patch.
#include "shaders/octahedral.glsl"
#include "shaders/triangles.glsl"

uniform sampler2D u_emissions;
uniform highp usampler2D u_reflectances;
uniform highp usampler2D u_patches;   // see ConvexPatches; a texel for each triangle of the world
uniform highp sampler2D u_triangles;  // see triangle_texture.h

layout(location = 0) out uvec4 o_owner;  // first of them and 1, how many, number of the patch or 0

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uint own = uint(texelFetch(u_emissions, at, 0).a);
  o_owner = uvec4(0u);
  if (own == 0u) return;
  // Number of the triangle, first of its patch, how many, 1: the front is outside, 2: the back.
  uvec4 patch_of = texelFetch(u_patches, texel_number(int(own) - 1, textureSize(u_patches, 0).x), 0);
  vec3 geometric = unpack_unit(texelFetch(u_reflectances, at, 0).w);
  vec3 a = corner_of(u_triangles, patch_of.x, 0).xyz;
  vec3 front = cross(corner_of(u_triangles, patch_of.x, 1).xyz - a, corner_of(u_triangles, patch_of.x, 2).xyz - a);
  uint side = dot(front, geometric) > 0.0 ? 1u : 2u;
  o_owner = (patch_of.w & side) != 0u ? uvec4(patch_of.y + 1u, patch_of.z, patch_of.y + 1u, 0u)
                                      : uvec4(patch_of.x + 1u, 1u, 0u, 0u);
}
