// SPDX-License-Identifier: MIT
// What is written of a quad of pixels: see shaders/interleaved.glsl.
#include "shaders/interleaved.glsl"

layout(location = 0) out vec4 o_red;
layout(location = 1) out vec4 o_green;
layout(location = 2) out vec4 o_blue;
