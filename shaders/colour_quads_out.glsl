// SPDX-License-Identifier: MIT
// What is written of a quad of pixels.
#include "shaders/colour_quads.glsl"

layout(location = 0) out vec4 o_red;
layout(location = 1) out vec4 o_green;
layout(location = 2) out vec4 o_blue;
