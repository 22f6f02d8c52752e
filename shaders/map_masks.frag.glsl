// SPDX-License-Identifier: MIT
// The masks of four pixels of a row.
#include "shaders/map_quads.glsl"

layout(location = 0) out uvec4 o_masks;

void main() {
  ivec2 first = first_pixel_of(ivec2(gl_FragCoord.xy)), last = textureSize(u_points, 0) - 1;
  o_masks = seen_by(receiver_at(min(first, last)), receiver_at(min(first + ivec2(1, 0), last)),
                    receiver_at(min(first + ivec2(2, 0), last)),
                    receiver_at(min(first + ivec2(3, 0), last)), first);
}
