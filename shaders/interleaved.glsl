// SPDX-License-Identifier: MIT
// Each pixel of a tile of TILE x TILE has its share of the lights; the shares' pictures stand side
// by side. Fragments make as many pixels of a row as a texel has channels, and textures hold them
// so: red, green and blue of four neighbours. The quads of one tile are neighbours in a row there.

const int kColumns = TILE < 4 ? TILE : 4;

ivec2 quad_of(ivec2 pixel) {
  return ivec2(pixel.x / kColumns * TILE + pixel.y % TILE, pixel.y / TILE);
}
ivec2 first_pixel_of(ivec2 quad) {
  return ivec2(quad.x / TILE * kColumns, quad.y * TILE + quad.x % TILE);
}

/// What is known of a tile, as bits: which neighbours are parts of the same plane, and whether the
/// tile is too rough for what its shares give to stand for its pixels.
const uint kBefore = 1u;
const uint kAfter = 2u;
const uint kAbove = 4u;
const uint kBelow = 8u;
const uint kRough = 16u;

/// The pixel that has this coordinate's share: at it or, if that is off this tile and not joined to
/// it, in this tile.
int within(int at, int tile, bool before, bool after) {
  if (at < tile * TILE) return before ? at : at + TILE;
  return at < (tile + 1) * TILE || after ? at : at - TILE;
}

/// Of a pixel so far away along one axis; the sum over all of a share is 1.
float nearness(int away) { return max(0.0, 1.0 - abs(float(away)) / float(TILE)); }
