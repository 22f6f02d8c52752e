// SPDX-License-Identifier: MIT
// Light for pixels that see of lights what maps tell.
#include "shaders/map_quads.glsl"
#include "shaders/shade_quad.glsl"

Point point_of(Receiver p, ivec2 pixel) {
  return Point(p.position, shading_normal_at(pixel), p.geometric);
}

void main() {
  Receivers r = receivers_of(ivec2(gl_FragCoord.xy));
  uvec4 masks = seen_by(r);
  shade(point_of(r.p0, r.at0), point_of(r.p1, r.at1), point_of(r.p2, r.at2),
        point_of(r.p3, r.at3), masks);
}
