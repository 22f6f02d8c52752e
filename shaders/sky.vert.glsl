// SPDX-License-Identifier: MIT
// One triangle that covers the screen, infinitely far.
uniform float u_far;  // z of what is there, w being 1

void main() {
  vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
  gl_Position = vec4(2.0 * corner - 1.0, u_far, 1.0);
}
