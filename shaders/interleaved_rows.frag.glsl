// SPDX-License-Identifier: MIT
// The shares of the row around each pixel brought together, as on a flat surface; alpha says
// whether the row is one.
#include "shaders/interleaved.glsl"

layout(location = 0) out vec4 o_row;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Surface surface = surface_at(at);
  o_row = vec4(0.0, 0.0, 0.0, 1.0);
  for (int away = -TILE; away < TILE; ++away) {
    ivec2 other = at + ivec2(away, 0);
    if (!is_inside(other) || likeness(surface, other) < kFlat) {
      o_row.a = 0.0;
      return;
    }
    o_row.rgb += (nearness(away) / kNearnessOfShare) * share_at(other);
  }
}
