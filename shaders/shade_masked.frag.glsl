// SPDX-License-Identifier: MIT
// Adds the irradiance of up to 32 lights to what there is: bit i of the mask says whether light i
// is seen. A fragment shades four pixels of a row: a light is looked up once for them, which on Mesa
// costs more than to shade one, and lights that none of them sees are left out.
#include "shaders/bits.glsl"
#include "shaders/colour_quads_out.glsl"
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_mask;
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform int u_count;

ivec2 inside(ivec2 at) { return min(at, textureSize(u_mask, 0) - 1); }

Point point_at(ivec2 at) {
  uvec4 bits = texelFetch(u_points, inside(at), 0);
  return Point(uintBitsToFloat(bits.xyz), unpack_unit(texelFetch(u_reflectances, inside(at), 0).w),
               unpack_unit(bits.w));
}

uint mask_at(ivec2 at) {
  uvec4 bytes = uvec4(texelFetch(u_mask, inside(at), 0) * 255.0 + 0.5);
  return bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
}

vec3 with_light(vec3 sum, Light light, Point p, uint bit, uint mask) {
  if ((mask & bit) != 0u) sum += irradiance_from(light, p);
  return sum;
}

void main() {
  ivec2 quad = ivec2(gl_FragCoord.xy), first = first_pixel_of(quad);
  ivec2 second = first + ivec2(1, 0), third = first + ivec2(2, 0), fourth = first + ivec2(3, 0);
  Point p0 = point_at(first), p1 = point_at(second), p2 = point_at(third), p3 = point_at(fourth);
  uvec4 mask = uvec4(mask_at(first), mask_at(second), mask_at(third), mask_at(fourth));
  o_red = texelFetch(u_red, quad, 0);
  o_green = texelFetch(u_green, quad, 0);
  o_blue = texelFetch(u_blue, quad, 0);
  vec3 sum0 = vec3(o_red.x, o_green.x, o_blue.x), sum1 = vec3(o_red.y, o_green.y, o_blue.y);
  vec3 sum2 = vec3(o_red.z, o_green.z, o_blue.z), sum3 = vec3(o_red.w, o_green.w, o_blue.w);
  uint left = (mask.x | mask.y | mask.z | mask.w) & lowest_bits(u_count);
  for (; left != 0u; left ^= lowest(left)) {
    uint bit = lowest(left);
    Light light = u_lights[number_of(bit)];
    sum0 = with_light(sum0, light, p0, bit, mask.x);
    sum1 = with_light(sum1, light, p1, bit, mask.y);
    sum2 = with_light(sum2, light, p2, bit, mask.z);
    sum3 = with_light(sum3, light, p3, bit, mask.w);
  }
  o_red = vec4(sum0.r, sum1.r, sum2.r, sum3.r);
  o_green = vec4(sum0.g, sum1.g, sum2.g, sum3.g);
  o_blue = vec4(sum0.b, sum1.b, sum2.b, sum3.b);
}
