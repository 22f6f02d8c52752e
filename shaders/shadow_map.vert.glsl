// SPDX-License-Identifier: MIT
// Triangles of the scene as a light sees them, into its shadow map.
layout(location = 0) in vec3 a_position;
layout(location = 1) in uint a_triangle;
layout(location = 2) in uint a_patch;
#if HOLES
layout(location = 3) in vec2 a_texcoord;
layout(location = 4) in vec4 a_colour;
layout(location = 5) in float a_height;  // the triangle's least
out vec2 v_texcoord;
out float v_alpha;
flat out float v_is_slender;  // rays might miss it
uniform float u_slender;      // the least height that they do not, where w is 1
#endif

uniform vec3 u_origin;
uniform mat4 u_clip;   // of positions relative to the origin
uniform vec3 u_depth;  // what grows with the distance from the light is the dot product with this

out float v_depth;
flat out uint v_triangle;
flat out uint v_patch;

void main() {
  vec3 place = a_position - u_origin;
  v_depth = dot(u_depth, place);
  v_triangle = a_triangle;
  v_patch = a_patch;
#if HOLES
  v_texcoord = a_texcoord;
  v_alpha = a_colour.a;
#endif
  gl_Position = u_clip * vec4(place, 1.0);
#if HOLES
  v_is_slender = a_height < u_slender * gl_Position.w ? 1.0 : 0.0;
#endif
}
