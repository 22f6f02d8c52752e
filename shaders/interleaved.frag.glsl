// SPDX-License-Identifier: MIT
// Irradiance by all lights out of that by each pixel's share of them. TILE * TILE shares stand side
// by side, the picture's pixel (x, y) in share (x, y) modulo TILE; each is looked up between the
// four of its pixels around this one, those that lie on another surface left out. [joint bilateral
// upsampling: Kopf et al. 2007]
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_shares;
uniform float u_plane_distance;

layout(location = 0) out vec4 o_irradiance;

ivec2 size, share_size;
vec3 position, shading, geometric;

/// How much the pixel says about this one; 0 on another surface.
float weight_of(ivec2 at, ivec2 away) {
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) return 0.0;
  uvec4 other = texelFetch(u_points, at, 0);
  // Beyond 30 degrees it is another side of things; within, what is alike counts more.
  const float kOtherSide = 0.866, kAlike = 32.0;
  float alike = dot(shading, unpack_unit(other.w));
  if (alike < kOtherSide) return 0.0;
  if (abs(dot(geometric, uintBitsToFloat(other.xyz) - position)) > u_plane_distance) return 0.0;
  vec2 near = 1.0 - abs(vec2(away)) / (float(TILE) + 0.5);
  return near.x * near.y * pow(alike, kAlike);
}

/// From this to the other of the two pixels of a share that are around.
int across(int away) { return away < 0 ? away + TILE : away - TILE; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  size = textureSize(u_points, 0);
  share_size = textureSize(u_shares, 0) / TILE;
  uvec4 bits = texelFetch(u_points, at, 0);
  position = uintBitsToFloat(bits.xyz);
  shading = unpack_unit(bits.w);
  geometric = unpack_unit(texelFetch(u_reflectances, at, 0).w);
  vec3 irradiance = vec3(0.0);
  float found = 0.0;
  for (int y = -TILE / 2; y < TILE / 2; ++y) {
    for (int x = -TILE / 2; x < TILE / 2; ++x) {
      ivec2 corner = ((at + ivec2(x, y) + TILE) % TILE) * share_size;
      vec3 sum = vec3(0.0);
      float weights = 0.0;
      for (int i = 0; i < 4; ++i) {
        ivec2 away = ivec2((i & 1) == 0 ? x : across(x), (i & 2) == 0 ? y : across(y));
        float weight = weight_of(at + away, away);
        if (weight == 0.0) continue;
        sum += weight * texelFetch(u_shares, corner + (at + away) / TILE, 0).rgb;
        weights += weight;
      }
      if (weights == 0.0) continue;
      irradiance += sum / weights;
      found += 1.0;
    }
  }
  // A surface too narrow to have met every share takes the mean of those it has.
  o_irradiance = vec4(irradiance * (float(TILE * TILE) / max(found, 1.0)), 1.0);
}
