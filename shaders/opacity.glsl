// SPDX-License-Identifier: MIT
// Where a surface with holes lets a ray through, as lantern/scene/surface.h says it.
#include "shaders/hash.glsl"
#include "shaders/texture.glsl"

uniform float u_opacity;
uniform float u_cutoff;  // opacity below it is a hole; negative: opacity is a share of the rays
uniform sampler2D u_opacity_texture;
uniform vec4 u_opacity_look_up;  // see shaders/surface.frag.glsl
uniform bool u_opacity_colours;
uniform uint u_seed;

/// `place` tells apart the rays that have a seed in common.
bool is_hole(uint triangle, ivec2 place, vec2 texcoord, float colour_alpha) {
  float opacity = u_opacity;
  if (u_opacity_look_up.w != 0.0) {
    opacity *= sample_texture(u_opacity_texture, texcoord, ivec2(u_opacity_look_up.xy),
                              u_opacity_look_up.z != 0.0).a;
  }
  if (u_opacity_colours) opacity *= colour_alpha;
  if (u_cutoff >= 0.0) return opacity < u_cutoff;
  uint random = hash(hash(hash(hash(u_seed) ^ triangle) ^ uint(place.x)) ^ uint(place.y));
  return float(random >> 8) * (1.0 / 16777216.0) >= opacity;
}
