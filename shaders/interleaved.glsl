// SPDX-License-Identifier: MIT
// Each pixel of a tile of TILE x TILE has its share of the lights; the shares' pictures stand side
// by side.

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
