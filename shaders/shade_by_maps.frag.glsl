// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is: bit i of the mask says whether light i
// is seen, and its shadow map must say so too.
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"
#include "shaders/shadow_maps.glsl"
uniform sampler2D u_emissions;

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
  uint own = uint(texelFetch(u_emissions, at, 0).a);
  uint open_ones = 0u;
  for (int i = 0; i < u_count; ++i) {
    uint bit = 1u << uint(i);
    if ((mask & bit) == 0u) continue;
    vec3 irradiance = irradiance_from(u_lights[i], p);
    if (irradiance == vec3(0.0)) continue;
    int told = look_up(i, p, way_to(u_lights[i], p), own);
    if (told == kOpen) open_ones |= bit;
    if (told != kSeen) continue;
    sum += irradiance;
  }
  // One ray against one triangle a turn, so that pixels that have more to do do not hold up others
  // at every light.
  Question open = new_question();
  while (open_ones != 0u) {
    uint bit = open_ones & (~open_ones + 1u);
    int i = int(floatBitsToUint(float(bit)) >> 23) - 127;
    bool shadowed = is_in_way(open, i, p, way_to(u_lights[i], p), own);
    if (!shadowed && !is_answered(open)) continue;
    if (!shadowed) sum += irradiance_from(u_lights[i], p);
    open_ones &= ~bit;
    open = new_question();
  }
  o_irradiance = vec4(sum, 1.0);
}
