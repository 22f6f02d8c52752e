// SPDX-License-Identifier: MIT
// The lights of a round, as many as go into one block, and which of them are seen.
#include "shaders/bits.glsl"
#include "shaders/lights.glsl"
#include "shaders/texel.glsl"

uniform sampler2D u_masks;             // of the shares' pictures
uniform highp usampler2D u_lights_of;  // of each share the first and how many

uint mask_at(ivec2 place) { return mask_of(texel_of(u_masks, place)); }

/// Lights of a share with so many that any of the four sees.
uint seen_by_any(uvec4 seen, int count) {
  return (seen.x | seen.y | seen.z | seen.w) & lowest_bits(count);
}

uvec4 bit(uvec4 bits, int i) { return (bits >> uint(i)) & 1u; }

float brightness(vec3 irradiance) { return irradiance.r + irradiance.g + irradiance.b; }
