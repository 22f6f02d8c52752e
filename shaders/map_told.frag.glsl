// SPDX-License-Identifier: MIT
// Which lights a pixel sees by what maps tell of its tile: depth 1 where that is not all, else 0.
#include "shaders/map_told.glsl"

layout(location = 0) out vec4 o_mask;

void main() {
  uvec2 told = told_of(ivec2(gl_FragCoord.xy));
  o_mask = bytes_of(told.x);
  gl_FragDepth = told.y != 0u ? 1.0 : 0.0;
}
