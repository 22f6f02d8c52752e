// SPDX-License-Identifier: MIT
/// A corner of a triangle in the texture of triangle_texture.h, and the number of the triangle
/// beyond the edge from it to the next and 1, or 0.
vec4 corner_of(uint triangle, int corner) {
  int at = 3 * int(triangle) + corner, width = textureSize(u_triangles, 0).x;
  return texelFetch(u_triangles, ivec2(at % width, at / width), 0);
}
