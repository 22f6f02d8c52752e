// SPDX-License-Identifier: MIT
// Radiance: what the surface emits and what it reflects of its irradiance.
#include "shaders/colour_quads.glsl"

uniform highp usampler2D u_reflectances;
uniform sampler2D u_emissions;
uniform sampler2D u_red, u_green, u_blue;

layout(location = 0) out vec4 o_radiance;

vec3 irradiance_of(ivec2 at) {
  ivec2 quad = quad_of(at);
  int i = at.x % kColumns;
  return vec3(texelFetch(u_red, quad, 0)[i], texelFetch(u_green, quad, 0)[i],
              texelFetch(u_blue, quad, 0)[i]);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  const float kInvPi = 0.318309886183791;
  vec4 radiance = texelFetch(u_emissions, at, 0);
  if (radiance.a != 0.0) {
    vec3 reflectance = uintBitsToFloat(texelFetch(u_reflectances, at, 0).xyz);
    radiance.rgb += reflectance * irradiance_of(at) * kInvPi;
  }
  o_radiance = radiance;
}
