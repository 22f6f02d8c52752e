// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is: bit i of the mask says whether light i
// is seen. The picture is cut into four strips of rows, and each fragment shades a pixel of each: a
// light is looked up once for four pixels, which on Mesa costs more than to shade one.
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_mask;
uniform highp usampler2D u_sum_0, u_sum_1, u_sum_2, u_sum_3;
uniform int u_count;

// The irradiance's bits.
layout(location = 0) out uvec4 o_irradiance_0;
layout(location = 1) out uvec4 o_irradiance_1;
layout(location = 2) out uvec4 o_irradiance_2;
layout(location = 3) out uvec4 o_irradiance_3;

ivec2 pixel_of(int strip) {
  ivec2 at = ivec2(gl_FragCoord.xy);
  // The last strip may be shorter; what is beyond is not looked at.
  int rows = textureSize(u_sum_0, 0).y;
  return ivec2(at.x, min(at.y + strip * rows, textureSize(u_mask, 0).y - 1));
}

Point point_of(int strip) {
  ivec2 at = pixel_of(strip);
  uvec4 bits = texelFetch(u_points, at, 0);
  Point p;
  p.position = uintBitsToFloat(bits.xyz);
  p.shading = unpack_unit(bits.w);
  p.geometric = unpack_unit(texelFetch(u_reflectances, at, 0).w);
  return p;
}

uint mask_of(int strip) {
  uvec4 bytes = uvec4(texelFetch(u_mask, pixel_of(strip), 0) * 255.0 + 0.5);
  return bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
}

vec3 sum_of(highp usampler2D before) {
  return uintBitsToFloat(texelFetch(before, ivec2(gl_FragCoord.xy), 0).rgb);
}

vec3 with_light(vec3 sum, Light light, Point p, uint bit, uint mask) {
  if ((mask & bit) != 0u) sum += irradiance_from(light, p);
  return sum;
}

uvec4 packed_sum(vec3 sum) { return uvec4(floatBitsToUint(sum), 0u); }

void main() {
  Point p0 = point_of(0), p1 = point_of(1), p2 = point_of(2), p3 = point_of(3);
  uvec4 mask = uvec4(mask_of(0), mask_of(1), mask_of(2), mask_of(3));
  vec3 sum0 = sum_of(u_sum_0), sum1 = sum_of(u_sum_1), sum2 = sum_of(u_sum_2);
  vec3 sum3 = sum_of(u_sum_3);
  for (int i = 0; i < u_count; ++i) {
    Light light = u_lights[i];
    uint bit = 1u << uint(i);
    sum0 = with_light(sum0, light, p0, bit, mask.x);
    sum1 = with_light(sum1, light, p1, bit, mask.y);
    sum2 = with_light(sum2, light, p2, bit, mask.z);
    sum3 = with_light(sum3, light, p3, bit, mask.w);
  }
  o_irradiance_0 = packed_sum(sum0);
  o_irradiance_1 = packed_sum(sum1);
  o_irradiance_2 = packed_sum(sum2);
  o_irradiance_3 = packed_sum(sum3);
}
