// SPDX-License-Identifier: MIT
// The masks of four pixels of a row.
#include "shaders/map_quads.glsl"

layout(location = 0) out uvec4 o_masks;

void main() { o_masks = seen_by(receivers_of(ivec2(gl_FragCoord.xy))); }
