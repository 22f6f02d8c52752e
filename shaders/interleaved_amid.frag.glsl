// SPDX-License-Identifier: MIT
// Covers the pixels of tiles amid their planes.
#include "shaders/colour_quads.glsl"
#include "shaders/interleaved.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_middles;  // see shaders/interleaved_middles.frag.glsl

void main() {
  ivec2 tile = first_pixel_of(ivec2(gl_FragCoord.xy)) / TILE;
  if ((texel_of(u_middles, tile).a & kAmidPlane) == 0u) discard;
}
