// SPDX-License-Identifier: MIT
// What maps are asked with, beside where points are: see map_receivers.glsl. The triangles that
// cannot be in the way of any light that a pixel faces are its own one or, on their outer side, all
// of its convex patch.
#include "shaders/map_receivers.glsl"
#include "shaders/texel.glsl"
#include "shaders/triangles.glsl"

uniform sampler2D u_emissions;
uniform highp usampler2D u_patches;  // see ConvexPatches; a texel for each triangle of the world

layout(location = 0) out uvec2 o_receiver;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float own = texel_of(u_emissions, at).a;
  o_receiver = uvec2(0u);
  if (own == 0.0) return;
  // Number of the triangle, first of its patch, how many, 1: the front is outside, 2: the back.
  Rows rows = rows_of(textureSize(u_patches, 0));
  uvec4 patch_of = texel_of(u_patches, rows.size, texel_number(int(abs(own)) - 1, rows));
  bool is_outside = (patch_of.w & (own > 0.0 ? 1u : 2u)) != 0u;
  o_receiver = is_outside ? uvec2(patch_of.y + 1u, patch_of.z | kHasPatch)
                          : uvec2(patch_of.x + 1u, 1u);
}
