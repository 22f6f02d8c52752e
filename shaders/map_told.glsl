// SPDX-License-Identifier: MIT
// What maps tell of a pixel's tile, of those lights that are asked for.
#include "shaders/map_tiles.glsl"

uniform highp usampler2D u_told;  // see shaders/map_tile_masks.frag.glsl
uniform sampler2D u_mask;         // lights that are asked for

/// Seen if the pixel faces them, and unknown.
uvec2 told_of(ivec2 pixel) {
  uvec4 bytes = uvec4(texelFetch(u_mask, pixel, 0) * 255.0 + 0.5);
  uint asked = bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
  return texelFetch(u_told, pixel / kTile, 0).xy & asked;
}

vec4 bytes_of(uint mask) {
  return vec4(uvec4(mask, mask >> 8, mask >> 16, mask >> 24) & 255u) / 255.0;
}
