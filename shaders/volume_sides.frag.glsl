// SPDX-License-Identifier: MIT
// Counts what is drawn in the steps of eight bits: fronts in red, backs in green.
layout(location = 0) out vec4 o_sides;
void main() {
  const float kOne = 1.0 / 255.0;
  o_sides = gl_FrontFacing ? vec4(kOne, 0.0, 0.0, 0.0) : vec4(0.0, kOne, 0.0, 0.0);
}
