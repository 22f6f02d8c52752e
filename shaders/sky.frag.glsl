// SPDX-License-Identifier: MIT
// Radiance from infinity. TEXTURED: lat-long, +y up, u = 0 towards -z and growing over +x.
uniform vec3 u_radiance;
#if TEXTURED
#include "shaders/texture.glsl"
uniform vec3 u_corner, u_step_x, u_step_y;  // the ray of pixel (0, 0) and from pixel to pixel
uniform sampler2D u_sky;
uniform vec4 u_look_up;
#endif

layout(location = 0) out uvec4 o_point;
layout(location = 1) out uvec4 o_reflectance;
layout(location = 2) out vec4 o_emission;

void main() {
  o_point = uvec4(0u);
  o_reflectance = uvec4(0u);
  vec3 radiance = u_radiance;
#if TEXTURED
  const float kPi = 3.14159265358979;
  vec2 at = floor(gl_FragCoord.xy);
  vec3 d = normalize(u_corner + u_step_x * at.x + u_step_y * at.y);
  float u = atan(d.x, -d.z) / (2.0 * kPi);
  vec2 uv = vec2(u < 0.0 ? u + 1.0 : u, acos(clamp(d.y, -1.0, 1.0)) / kPi);
  radiance *= max(sample_texture(u_sky, uv, ivec2(u_look_up.xy), u_look_up.z != 0.0).rgb, 0.0);
#endif
  o_emission = vec4(radiance, 0.0);
}
