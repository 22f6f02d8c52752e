// SPDX-License-Identifier: MIT
// The pictures of all shares side by side, from that of all pixels: depth and, with POINTS, all of
// the G-buffer.
#include "shaders/interleaved.glsl"
#include "shaders/texel.glsl"

uniform highp sampler2D u_depth;
uniform ivec2 u_share_size;
#if POINTS
uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_emissions;

layout(location = 0) out uvec4 o_point;
layout(location = 1) out uvec4 o_reflectance;
layout(location = 2) out vec4 o_emission;
#endif

void main() {
  // In floats: Mesa divides integers one by one.
  ivec2 place = ivec2(gl_FragCoord.xy), share = ivec2(gl_FragCoord.xy / vec2(u_share_size));
  ivec2 at = share + TILE * (place - share * u_share_size);
  at = min(at, textureSize(u_depth, 0) - 1);
#if POINTS
  o_point = texel_of(u_points, at);
  o_reflectance = texel_of(u_reflectances, at);
  o_emission = texel_of(u_emissions, at);
#endif
  gl_FragDepth = texel_of(u_depth, at).r;
}
