// SPDX-License-Identifier: MIT
// The G-buffer of every TILE-th pixel, from that of all.
uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_emissions;
uniform highp sampler2D u_depth;
uniform ivec2 u_first;

layout(location = 0) out uvec4 o_point;
layout(location = 1) out uvec4 o_reflectance;
layout(location = 2) out vec4 o_emission;

void main() {
  ivec2 at = u_first + TILE * ivec2(gl_FragCoord.xy);
  at = min(at, textureSize(u_points, 0) - 1);
  o_point = texelFetch(u_points, at, 0);
  o_reflectance = texelFetch(u_reflectances, at, 0);
  o_emission = texelFetch(u_emissions, at, 0);
  gl_FragDepth = texelFetch(u_depth, at, 0).r;
}
