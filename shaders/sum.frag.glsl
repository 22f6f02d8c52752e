// SPDX-License-Identifier: MIT
// The sum over each block of 16x16 texels; WEIGHTED by the area of the elements.
#include "shaders/texel.glsl"

uniform sampler2D values;
#ifdef WEIGHTED
uniform sampler2D normals;  // w: exposed area
#endif

layout(location = 0) out vec4 sums;

void main() {
  ivec2 size = textureSize(values, 0);
  ivec2 corner = 16 * ivec2(gl_FragCoord.xy);
  vec4 sum = vec4(0.0);
  for (int y = corner.y; y < min(corner.y + 16, size.y); ++y) {
    for (int x = corner.x; x < min(corner.x + 16, size.x); ++x) {
      vec4 value = texel_of(values, ivec2(x, y));
#ifdef WEIGHTED
      value *= texel_of(normals, ivec2(x, y)).w;
#endif
      sum += value;
    }
  }
  sums = sum;
}
