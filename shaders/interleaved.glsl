// SPDX-License-Identifier: MIT
// TILE * TILE shares of the light stand side by side in one picture, the whole picture's pixel (x, y)
// in share (x, y) modulo TILE. Each is looked up between the four of its pixels around a pixel.
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_shares;
uniform float u_plane_distance;

struct Surface {
  vec3 position, shading, geometric;
};

Surface surface_at(ivec2 at) {
  uvec4 bits = texelFetch(u_points, at, 0);
  return Surface(uintBitsToFloat(bits.xyz), unpack_unit(bits.w),
                 unpack_unit(texelFetch(u_reflectances, at, 0).w));
}

/// The cosine between the shading normals, or 0 if the other pixel is not in the surface's plane.
float likeness(Surface surface, ivec2 other) {
  uvec4 bits = texelFetch(u_points, other, 0);
  float off = dot(surface.geometric, uintBitsToFloat(bits.xyz) - surface.position);
  return abs(off) > u_plane_distance ? 0.0 : dot(surface.shading, unpack_unit(bits.w));
}

/// Of a pixel so far away along one axis; over the two of each share that are around the sum is the
/// same.
float nearness(int away) { return 1.0 - abs(float(away)) / (float(TILE) + 0.5); }
const float kNearnessOfShare = 2.0 - float(TILE) / (float(TILE) + 0.5);

/// Above this cosine a surface counts as flat.
const float kFlat = 0.999;

bool is_inside(ivec2 at) {
  return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, textureSize(u_points, 0)));
}

vec3 share_at(ivec2 at) {
  return texelFetch(u_shares, (at % TILE) * (textureSize(u_shares, 0) / TILE) + at / TILE, 0).rgb;
}
