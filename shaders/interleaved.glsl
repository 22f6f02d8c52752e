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

/// Where a pixel stands among the shares' pictures, together of this size.
ivec2 place_among_shares(ivec2 pixel, ivec2 size) {
  return (pixel % TILE) * (size / TILE) + pixel / TILE;
}

/// How far a pixel is from the middle of its tile, along one axis, in tiles.
float off_middle(int pixel) { return (float(pixel % TILE) + 0.5) / float(TILE) - 0.5; }

/// What is known of a tile, as bits: which neighbours are parts of the same plane, whether it is
/// too rough for what is known of its middle to stand for its pixels, and whether all eight around
/// are parts of its plane.
const uint kBefore = 1u;
const uint kAfter = 2u;
const uint kAbove = 4u;
const uint kBelow = 8u;
const uint kRough = 16u;
const uint kAmidPlane = 32u;
