// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is: bit i of the mask says whether light i
// is seen.
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_mask;
uniform sampler2D u_sum;
uniform int u_count;

layout(location = 0) out vec4 o_irradiance;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 sum = texelFetch(u_sum, at, 0).rgb;
  uvec4 bytes = uvec4(texelFetch(u_mask, at, 0) * 255.0 + 0.5);
  uint mask = bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
  uvec4 bits = texelFetch(u_points, at, 0);
  Point p;
  p.position = uintBitsToFloat(bits.xyz);
  p.shading = unpack_unit(bits.w);
  p.geometric = unpack_unit(texelFetch(u_reflectances, at, 0).w);
  for (int i = 0; i < u_count; ++i) {
    if ((mask & (1u << uint(i))) != 0u) sum += irradiance_from(u_lights[i], p);
  }
  o_irradiance = vec4(sum, 1.0);
}
