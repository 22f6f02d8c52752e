// SPDX-License-Identifier: MIT
// Light for pixels that see of lights what maps tell.
#include "shaders/map_quads.glsl"
#include "shaders/shade_quad.glsl"

Point point_of(Receiver p, ivec2 pixel) {
  return Point(p.position, shading_normal_at(pixel), p.geometric);
}

void main() {
  ivec2 first = first_pixel_of(ivec2(gl_FragCoord.xy));
  ivec2 at0 = inside(first), at1 = inside(first + ivec2(1, 0));
  ivec2 at2 = inside(first + ivec2(2, 0)), at3 = inside(first + ivec2(3, 0));
  Receiver p0 = receiver_at(at0), p1 = receiver_at(at1);
  Receiver p2 = receiver_at(at2), p3 = receiver_at(at3);
  uvec4 masks = seen_by(p0, p1, p2, p3, first);
  shade(point_of(p0, at0), point_of(p1, at1), point_of(p2, at2), point_of(p3, at3), masks);
}
