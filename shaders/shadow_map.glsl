// SPDX-License-Identifier: MIT
// A shadow map is a square of u_map_size texels a side, a power of two. Directions unfold into it as an octahedron does,
// whose faces are perspective pictures each: what is straight stays straight. The hemisphere around
// the frame's z lies inside the diamond, the other one outside, so that two lights that shine to
// one side share a map.
uniform int u_map_size;

/// Less than 0 inside the diamond, more outside, 0 on it.
int off_diamond(ivec2 texel) {
  ivec2 off_centre = abs(2 * texel + 1 - u_map_size);
  return off_centre.x + off_centre.y - u_map_size;
}

// What a texel says: the number of the triangle that it sees and 1, or 0, and how far that is.
// Finished maps say of the block of two by two whose first texel it is how far its furthest is, and
// in the highest bits which others see triangles that those before them do not. What a triangle with
// holes stops is known for each texel alone.
const uint kNumber = 0x0fffffffu;
const uint kHoles = 0x10000000u;
const uint kOthers = 29u;
