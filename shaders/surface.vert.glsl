// SPDX-License-Identifier: MIT
// Triangles of the scene as the eye sees them.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_geometric_normal;
layout(location = 2) in vec3 a_normal;
layout(location = 3) in vec2 a_texcoord;
layout(location = 4) in vec4 a_colour;
layout(location = 5) in uint a_triangle;

uniform vec3 u_eye;
uniform mat4 u_clip;  // of positions relative to the eye

out vec3 v_position;
flat out vec3 v_geometric_normal;
out vec3 v_normal;
out vec2 v_texcoord;
out vec4 v_colour;
flat out uint v_triangle;

invariant gl_Position;

void main() {
  v_position = a_position;
  v_geometric_normal = a_geometric_normal;
  v_normal = a_normal;
  v_texcoord = a_texcoord;
  v_colour = a_colour;
  v_triangle = a_triangle;
  gl_Position = u_clip * vec4(a_position - u_eye, 1.0);
}
