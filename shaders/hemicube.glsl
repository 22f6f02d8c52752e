// SPDX-License-Identifier: MIT
// Where the pixels of a hemicube about +z lie in a texture of n by 3n texels: the top in the lowest n
// rows, then n/2 rows for each of the sides +x, -x, +y, -y. Read by GLSL and C++. [Cohen & Greenberg
// 1985]
#pragma once

/// The pixel that sees along d, d.z above zero.
LANTERN_SHARED ivec2 hemicube_pixel(vec3 d, int n) {
  vec3 a = abs(d);
  int half_n = n / 2;
  if (a.z >= a.x && a.z >= a.y) {
    float scale = 0.5f * float(n) / a.z;
    float middle = 0.5f * float(n);
    return ivec2(min(int(d.x * scale + middle), n - 1), min(int(d.y * scale + middle), n - 1));
  }
  bool along_x = a.x >= a.y;
  float w = along_x ? a.x : a.y;
  float u = (along_x ? d.y : d.x) / w;
  int face = along_x ? (d.x > 0.0f ? 0 : 1) : (d.y > 0.0f ? 2 : 3);
  return ivec2(min(int((u + 1.0f) * 0.5f * float(n)), n - 1),
               n + face * half_n + min(int(d.z / w * float(half_n)), half_n - 1));
}

/// The form factor of a pixel: cosine times area over pi r^4, r the distance on the cube. Section 5 of
/// the paper; over all pixels its sum is 1 + O(1/n^2).
LANTERN_SHARED float hemicube_delta(ivec2 pixel, int n) {
  const float pi = 3.14159265358979f;
  float pixel_size = 2.0f / float(n);
  float u = (float(pixel.x) + 0.5f) * pixel_size - 1.0f;
  float v = 0.0f;
  float height = 1.0f;
  if (pixel.y < n) {
    v = (float(pixel.y) + 0.5f) * pixel_size - 1.0f;
  } else {
    height = (float((pixel.y - n) % (n / 2)) + 0.5f) * pixel_size;
    v = 1.0f;
  }
  float square = u * u + v * v + height * height;
  return height * pixel_size * pixel_size / (pi * square * square);
}
