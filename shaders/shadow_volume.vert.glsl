// SPDX-License-Identifier: MIT
// Vertices of shadow volumes, three of each of the casters': where it is, where the ray from the
// light through it leaves a box, and infinitely far along that ray; then corners of the screen.
layout(location = 0) in vec3 a_position;

uniform vec3 u_eye;
uniform mat4 u_clip;
uniform vec4 u_light;  // position and 1, or the direction towards it and 0
uniform vec3 u_low, u_high;
uniform int u_corners;  // number of the first
uniform float u_cover;  // z of what covers the screen, w being 1

invariant gl_Position;

void main() {
  if (gl_VertexID >= u_corners) {
    gl_Position = vec4(a_position.xy, u_cover, 1.0);
    return;
  }
  vec3 way = u_light.w * a_position - u_light.xyz;
  int kind = gl_VertexID % 3;
  if (kind == 0) {
    gl_Position = u_clip * vec4(a_position - u_eye, 1.0);
  } else if (kind == 1) {
    vec3 room = mix(a_position - u_low, u_high - a_position, greaterThan(way, vec3(0.0)));
    vec3 steps = room / max(abs(way), 1e-30);
    float far = min(steps.x, min(steps.y, steps.z));
    gl_Position = u_clip * vec4(a_position + far * way - u_eye, 1.0);
  } else {
    gl_Position = u_clip * vec4(way, 0.0);
  }
}
