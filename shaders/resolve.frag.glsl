// SPDX-License-Identifier: MIT
// Radiance: what the surface emits and what it reflects of its irradiance; with ADD added to that of
// other samples.
#include "shaders/colour_quads_out.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_reflectances;
uniform sampler2D u_emissions;
uniform sampler2D u_red, u_green, u_blue;  // irradiance
#if ADD
uniform sampler2D u_red_before, u_green_before, u_blue_before;
#endif

vec3 radiance_of(ivec2 at, vec3 irradiance) {
  at = min(at, textureSize(u_emissions, 0) - 1);
  const float kInvPi = 0.318309886183791;
  vec4 emission = texel_of(u_emissions, at);
  if (emission.a == 0.0) return emission.rgb;  // the sky
  vec3 reflectance = uintBitsToFloat(texel_of(u_reflectances, at).xyz);
  return emission.rgb + reflectance * irradiance * kInvPi;
}

void main() {
  ivec2 quad = ivec2(gl_FragCoord.xy), first = first_pixel_of(quad);
  vec4 red = texel_of(u_red, quad), green = texel_of(u_green, quad);
  vec4 blue = texel_of(u_blue, quad);
  vec3 radiance0 = radiance_of(first, vec3(red.x, green.x, blue.x));
  vec3 radiance1 = radiance_of(first + ivec2(1, 0), vec3(red.y, green.y, blue.y));
  vec3 radiance2 = radiance_of(first + ivec2(2, 0), vec3(red.z, green.z, blue.z));
  vec3 radiance3 = radiance_of(first + ivec2(3, 0), vec3(red.w, green.w, blue.w));
  write_quad(radiance0, radiance1, radiance2, radiance3);
#if ADD
  o_red += texel_of(u_red_before, quad);
  o_green += texel_of(u_green_before, quad);
  o_blue += texel_of(u_blue_before, quad);
#endif
}
