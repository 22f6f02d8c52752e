// SPDX-License-Identifier: MIT
// Each pixel of a tile of TILE x TILE has its share of the lights. Fragments make as many pixels of
// a row as a texel has channels, and textures hold them so: red, green and blue of four neighbours.
#include "shaders/octahedral.glsl"

const int kColumns = TILE < 4 ? TILE : 4;

uniform highp usampler2D u_tiles;  // see shaders/interleaved_tiles.frag.glsl
uniform float u_plane_distance;

/// Above this cosine a surface counts as flat.
const float kFlat = 0.999;
/// In place of the normal of a tile that is not: no unit vector.
const uint kRough = 0xffffffffu;

/// Whether a point is in the plane of another, up to a distance, and has about its normal.
bool is_in_plane(uvec4 plane, uvec4 point) {
  if (point == uvec4(0u) || plane == uvec4(0u)) return point == plane;  // the sky
  vec3 normal = unpack_unit(plane.w);
  float off = dot(normal, uintBitsToFloat(point.xyz) - uintBitsToFloat(plane.xyz));
  return abs(off) < u_plane_distance && dot(normal, unpack_unit(point.w)) > kFlat;
}

/// Whether both tiles are parts of one plane.
bool are_joined(ivec2 tile, ivec2 other) {
  ivec2 size = textureSize(u_tiles, 0);
  if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) return false;
  uvec4 a = texelFetch(u_tiles, tile, 0), b = texelFetch(u_tiles, other, 0);
  return a.w != kRough && b.w != kRough && is_in_plane(a, b);
}

/// The one that has this coordinate's share, at it or, if that is off this tile and not joined to
/// it, in this tile.
int within(int at, int tile, bool before, bool after) {
  if (at < tile * TILE) return before ? at : at + TILE;
  return at < (tile + 1) * TILE || after ? at : at - TILE;
}

/// Of a pixel so far away along one axis; the sum over all of a share is 1.
float nearness(int away) { return max(0.0, 1.0 - abs(float(away)) / float(TILE)); }
