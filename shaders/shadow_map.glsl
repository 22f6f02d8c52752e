// SPDX-License-Identifier: MIT
// A shadow map is a square of u_map_size texels a side, a power of two. Directions unfold into it
// as an octahedron does, whose faces are perspective pictures each: what is straight stays straight.
// The hemisphere around the frame's z lies inside the diamond, the other one outside, so that two
// lights that shine to one side share a map.
uniform int u_map_size;

/// Less than 0 inside the diamond, more outside, 0 on it.
int off_diamond(ivec2 texel) {
  ivec2 off_centre = abs(2 * texel + 1 - u_map_size);
  return off_centre.x + off_centre.y - u_map_size;
}

// What a texel sees: the number of a triangle and 1, or 0. What a triangle with holes stops is known
// for each texel alone.
const uint kNumber = 0x0fffffffu;
const uint kHoles = 0x10000000u;

// What the block of two by two texels sees whose first one this is: the patch of its nearest
// triangle, or 0; how far the nearest of other patches is and, in the lower half, the furthest of
// all: the first 16 bits of floats.
const uint kInfinitelyFar = 0x7f00u;
const uint kNoPatch = 0xffffffffu;  // of what has holes, and of several

// The same of larger windows: those of level n are 2 << n texels wide and begin at every (1 << n)th;
// they stand beside the blocks, which are level 0, one below the other.
const int kMapLevels = 5;

ivec2 corner_of_level(int level, ivec2 size_of_blocks) {
  return level == 0 ? ivec2(0)
                    : ivec2(size_of_blocks.x, size_of_blocks.y - (size_of_blocks.y >> (level - 1)));
}

float near_of(uint depths) { return uintBitsToFloat(depths & 0xffff0000u); }
float far_of(uint depths) { return uintBitsToFloat(depths << 16); }
