// SPDX-License-Identifier: MIT
// Radiance: what the surface emits and what it reflects of its irradiance.
uniform highp usampler2D u_reflectances;
uniform sampler2D u_emissions;
uniform sampler2D u_irradiance;

layout(location = 0) out vec4 o_radiance;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  const float kInvPi = 0.318309886183791;
  vec4 radiance = texelFetch(u_emissions, at, 0);
  if (radiance.a != 0.0) {
    vec3 reflectance = uintBitsToFloat(texelFetch(u_reflectances, at, 0).xyz);
    radiance.rgb += reflectance * texelFetch(u_irradiance, at, 0).rgb * kInvPi;
  }
  o_radiance = radiance;
}
