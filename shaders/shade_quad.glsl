// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is of four pixels of a row. A light is
// looked up once for them, which on Mesa costs more than to shade one, and lights that none of them
// sees are left out.
#include "shaders/bits.glsl"
#include "shaders/colour_quads_out.glsl"
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_reflectances;
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform bool u_first_lights;               // there is nothing yet

vec3 shading_normal_at(ivec2 pixel) {
  return unpack_unit(texel_of(u_reflectances, pixel).w);
}

vec3 with_light(vec3 sum, Light light, Point p, uint bit, uint mask) {
  if ((mask & bit) != 0u) sum += irradiance_from(light, p);
  return sum;
}

/// Bit i of a pixel's mask: whether it sees light i.
void shade(Point p0, Point p1, Point p2, Point p3, uvec4 mask) {
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
  uint left = mask.x | mask.y | mask.z | mask.w;
  if (left != 0u) {
    do {
      uint bit = lowest(left);
      Light light = u_lights[number_of(bit)];
      sum0 = with_light(sum0, light, p0, bit, mask.x);
      sum1 = with_light(sum1, light, p1, bit, mask.y);
      sum2 = with_light(sum2, light, p2, bit, mask.z);
      sum3 = with_light(sum3, light, p3, bit, mask.w);
      left ^= bit;
    } while (left != 0u);
  }
  write_quad(sum0, sum1, sum2, sum3);
  if (u_first_lights) return;
  o_red += texel_of(u_red, ivec2(gl_FragCoord.xy));
  o_green += texel_of(u_green, ivec2(gl_FragCoord.xy));
  o_blue += texel_of(u_blue, ivec2(gl_FragCoord.xy));
}
