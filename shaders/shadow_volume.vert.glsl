// SPDX-License-Identifier: MIT
// Vertices of shadow volumes: those of even number stay where they are, odd ones go to infinity,
// away from the light.
layout(location = 0) in vec3 a_position;

uniform vec3 u_eye;
uniform mat4 u_clip;
uniform vec4 u_light;  // position and 1, or the direction towards it and 0

invariant gl_Position;

void main() {
  if ((gl_VertexID & 1) == 0) {
    gl_Position = u_clip * vec4(a_position - u_eye, 1.0);
  } else {
    gl_Position = u_clip * vec4(u_light.w * a_position - u_light.xyz, 0.0);
  }
}
