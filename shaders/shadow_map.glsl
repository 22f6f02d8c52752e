// SPDX-License-Identifier: MIT
// A shadow map is a square of u_map_size texels a side. All directions unfold into it as an
// octahedron does, those of a light that shines to one side as one half of it, turned by an eighth.
// Each face is a perspective picture: what is straight stays straight.
uniform int u_map_size;

/// Of a texel's centre, twice.
ivec2 off_centre(ivec2 texel) { return 2 * texel + 1 - u_map_size; }

// What a texel sees: the number of a triangle and 1, or 0. What a triangle with holes stops is known
// for each texel alone, but a veil stops the same share of the rays everywhere.
const uint kNumber = 0x0fffffffu;
const uint kHoles = 0x10000000u;
const uint kVeil = 0x20000000u;  // beside kHoles

// What the block of two by two texels sees whose first one this is: the patch of its nearest
// triangle, or 0; how far the nearest of other patches is and, in the lower half, the furthest of
// all: the first 16 bits of floats.
const uint kInfinitelyFar = 0x7f00u;
const uint kNoPatch = 0xffffffffu;  // of what has holes, and of several

// The same of larger windows: those of level n are 2 << n texels wide and begin at every (1 << n)th.
// Levels stand beside the blocks, which are level 0, one after the other upwards.
const int kMapLevels = 6;

ivec2 corner_of_level(int level, ivec2 size_of_blocks) {
  return level == 0 ? ivec2(0)
                    : ivec2(size_of_blocks.x, size_of_blocks.y - (size_of_blocks.y >> (level - 1)));
}

float near_of(uint depths) { return uintBitsToFloat(depths & 0xffff0000u); }
float far_of(uint depths) { return uintBitsToFloat(depths << 16); }
