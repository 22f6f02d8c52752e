// SPDX-License-Identifier: MIT
// Triangles of the scene as a light sees them, into its shadow map.
layout(location = 0) in vec3 a_position;
layout(location = 1) in uint a_triangle;

uniform vec3 u_origin;
uniform mat4 u_clip;   // of positions relative to the origin
uniform vec3 u_depth;  // what grows with the distance from the light is the dot product with this

out float v_depth;
flat out uint v_triangle;

void main() {
  vec3 place = a_position - u_origin;
  v_depth = dot(u_depth, place);
  v_triangle = a_triangle;
  gl_Position = u_clip * vec4(place, 1.0);
}
