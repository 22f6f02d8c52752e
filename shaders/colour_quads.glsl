// SPDX-License-Identifier: MIT
// Fragments make as many pixels of a row as a texel has channels, and textures hold them so: red,
// green and blue of four neighbours, or their masks. The quads of one tile of TILE x TILE pixels are
// neighbours in a row there.
const int kColumns = TILE == 2 ? 2 : 4;

ivec2 quad_of(ivec2 pixel) {
  return ivec2(pixel.x / kColumns * TILE + pixel.y % TILE, pixel.y / TILE);
}
ivec2 first_pixel_of(ivec2 quad) {
  return ivec2(quad.x / TILE * kColumns, quad.y * TILE + quad.x % TILE);
}
