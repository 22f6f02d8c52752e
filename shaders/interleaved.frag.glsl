// SPDX-License-Identifier: MIT
// Irradiance by all lights out of that by each pixel's share of them. On a flat surface that fills
// the window it is a tent in each direction; elsewhere those pixels of a share that lie on another
// surface are left out. [joint bilateral upsampling: Kopf et al. 2007]
#include "shaders/interleaved.glsl"

uniform sampler2D u_rows;

layout(location = 0) out vec4 o_irradiance;

/// Out of the rows around; alpha is 0 unless all of them are of this surface.
vec4 flat_irradiance(ivec2 at, Surface surface) {
  vec3 sum = vec3(0.0);
  for (int away = -TILE; away < TILE; ++away) {
    ivec2 other = at + ivec2(0, away);
    if (!is_inside(other)) return vec4(0.0);
    vec4 row = texelFetch(u_rows, other, 0);
    if (row.a == 0.0 || likeness(surface, other) < kFlat) return vec4(0.0);
    sum += (nearness(away) / kNearnessOfShare) * row.rgb;
  }
  return vec4(sum, 1.0);
}

/// How much the pixel says about this one; 0 on another surface.
float weight_of(Surface surface, ivec2 at, ivec2 away) {
  if (!is_inside(at)) return 0.0;
  // Beyond 30 degrees it is another side of things; within, what is alike counts more.
  const float kOtherSide = 0.866, kAlike = 32.0;
  float alike = likeness(surface, at);
  return alike < kOtherSide ? 0.0 : nearness(away.x) * nearness(away.y) * pow(alike, kAlike);
}

/// From this to the other of the two pixels of a share that are around.
int across(int away) { return away < 0 ? away + TILE : away - TILE; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Surface surface = surface_at(at);
  o_irradiance = flat_irradiance(at, surface);
  if (o_irradiance.a > 0.0) return;
  vec3 irradiance = vec3(0.0);
  float found = 0.0;
  for (int y = -TILE / 2; y < TILE / 2; ++y) {
    for (int x = -TILE / 2; x < TILE / 2; ++x) {
      vec3 sum = vec3(0.0);
      float weights = 0.0;
      for (int i = 0; i < 4; ++i) {
        ivec2 away = ivec2((i & 1) == 0 ? x : across(x), (i & 2) == 0 ? y : across(y));
        float weight = weight_of(surface, at + away, away);
        if (weight == 0.0) continue;
        sum += weight * share_at(at + away);
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
