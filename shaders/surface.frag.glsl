// SPDX-License-Identifier: MIT
// The surface that a pixel sees, as lantern/scene/surface.h says it: where it is (lifted off it, as
// shadow rays start), its two normals on the side that is seen, what it reflects and emits; with
// HOLES where it lets the eye's ray through nothing.
#include "shaders/octahedral.glsl"
#include "shaders/texture.glsl"
#if HOLES
#include "shaders/opacity.glsl"
uniform ivec2 u_first_pixel;  // column i, row j of the framebuffer: this + u_pixel_step * (i, j)
uniform int u_pixel_step;
#endif

in vec3 v_position;
flat in vec3 v_geometric_normal;
in vec3 v_normal;
in vec2 v_texcoord;
in vec4 v_colour;
flat in uint v_triangle;

uniform vec3 u_eye;
uniform float u_lift;
uniform vec3 u_reflectance;
uniform vec3 u_emission;
uniform bool u_double_sided;
uniform bool u_vertex_colours;
#if TEXTURED
uniform sampler2D u_reflectance_texture;
uniform sampler2D u_emission_texture;
// (how it wraps in u and in v, 1: sRGB bytes, 1: there is one)
uniform vec4 u_reflectance_look_up;
uniform vec4 u_emission_look_up;
#endif

layout(location = 0) out uvec4 o_point;       // position's bits, geometric normal
layout(location = 1) out uvec4 o_reflectance; // its bits, shading normal
layout(location = 2) out vec4 o_emission;     // radiance; number of the triangle and 1, negative if
                                              // its back is seen

#if TEXTURED
vec3 looked_up(sampler2D image, vec4 how) {
  if (how.w == 0.0) return vec3(1.0);
  return sample_texture(image, v_texcoord, ivec2(how.xy), how.z != 0.0).rgb;
}
#endif

void main() {
#if HOLES
  ivec2 pixel = u_first_pixel + u_pixel_step * ivec2(gl_FragCoord.xy);
  if (is_hole(v_triangle, pixel, v_texcoord, v_colour.a)) discard;
#endif
  bool front = dot(v_geometric_normal, v_position - u_eye) < 0.0;
  vec3 geometric = v_geometric_normal;
  vec3 shading = geometric;
  // Shorter than this the vertices disagree so much that their mean says nothing.
  const float kShortest = 1e-3;
  float size = length(v_normal);
  if (size > kShortest) {
    shading = v_normal / size;
    if (dot(shading, geometric) < 0.0) shading = -shading;
  }
  float side = front ? 1.0 : -1.0;
  vec3 reflectance = u_reflectance, emission = u_emission;
  if (u_vertex_colours) reflectance *= v_colour.rgb;
  if (!front && !u_double_sided) emission = vec3(0.0);
#if TEXTURED
  reflectance *= looked_up(u_reflectance_texture, u_reflectance_look_up);
  emission *= looked_up(u_emission_texture, u_emission_look_up);
#endif
  reflectance = clamp(reflectance, 0.0, 1.0);

  vec3 lifted = v_position + geometric * (side * u_lift);
  o_point = uvec4(floatBitsToUint(lifted), pack_unit(geometric * side));
  o_reflectance = uvec4(floatBitsToUint(reflectance), pack_unit(shading * side));
  // Floats count no further; half a number is no triangle's.
  const uint kCounted = 0xffffffu;
  o_emission = vec4(emission, side * (v_triangle < kCounted ? float(v_triangle + 1u) : 0.5));
}
