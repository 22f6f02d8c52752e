// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is: bit i of the mask says whether light i
// is seen. The picture is cut into four strips of rows, and each fragment shades a pixel of each: a
// light is looked up once for four pixels, which on Mesa costs more than to shade one.
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_mask;
uniform sampler2D u_sum_0, u_sum_1, u_sum_2, u_sum_3;
uniform int u_count;

layout(location = 0) out vec4 o_irradiance_0;
layout(location = 1) out vec4 o_irradiance_1;
layout(location = 2) out vec4 o_irradiance_2;
layout(location = 3) out vec4 o_irradiance_3;

ivec2 pixel_of(int strip) {
  ivec2 at = ivec2(gl_FragCoord.xy);
  // The last strip may be shorter; what is beyond is not looked at.
  int rows = textureSize(u_sum_0, 0).y;
  return ivec2(at.x, min(at.y + strip * rows, textureSize(u_points, 0).y - 1));
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

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Point p0 = point_of(0), p1 = point_of(1), p2 = point_of(2), p3 = point_of(3);
  uvec4 mask = uvec4(mask_of(0), mask_of(1), mask_of(2), mask_of(3));
  vec3 sum0 = texelFetch(u_sum_0, at, 0).rgb, sum1 = texelFetch(u_sum_1, at, 0).rgb;
  vec3 sum2 = texelFetch(u_sum_2, at, 0).rgb, sum3 = texelFetch(u_sum_3, at, 0).rgb;
  for (int i = 0; i < u_count; ++i) {
    Light light = u_lights[i];
    bvec4 seen = notEqual(mask & (1u << uint(i)), uvec4(0u));
    if (seen.x) sum0 += irradiance_from(light, p0);
    if (seen.y) sum1 += irradiance_from(light, p1);
    if (seen.z) sum2 += irradiance_from(light, p2);
    if (seen.w) sum3 += irradiance_from(light, p3);
  }
  o_irradiance_0 = vec4(sum0, 1.0);
  o_irradiance_1 = vec4(sum1, 1.0);
  o_irradiance_2 = vec4(sum2, 1.0);
  o_irradiance_3 = vec4(sum3, 1.0);
}
