// SPDX-License-Identifier: MIT
// What is written of a quad of pixels.
#include "shaders/colour_quads.glsl"

layout(location = 0) out vec4 o_red;
layout(location = 1) out vec4 o_green;
layout(location = 2) out vec4 o_blue;

void write_quad(vec3 c0, vec3 c1, vec3 c2, vec3 c3) {
  o_red = vec4(c0.r, c1.r, c2.r, c3.r);
  o_green = vec4(c0.g, c1.g, c2.g, c3.g);
  o_blue = vec4(c0.b, c1.b, c2.b, c3.b);
}
