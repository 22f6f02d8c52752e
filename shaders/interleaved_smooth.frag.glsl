// SPDX-License-Identifier: MIT
// Irradiance where the surface is smooth, from that of the middles of its tile and of those around;
// where these are not parts of its plane, as it goes on from the other side.
#include "shaders/colour_quads_out.glsl"
#include "shaders/interleaved.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_middles;  // see shaders/interleaved_middles.frag.glsl

vec3 irradiance_of(uvec4 middle) { return uintBitsToFloat(middle.rgb); }

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy)), tile = at / TILE;
  uvec4 here = texel_of(u_middles, tile);
  if ((here.a & kRough) != 0u) discard;
  vec3 middle = irradiance_of(here);

  // Along columns first.
  float off = off_middle(at.y), part = abs(off);
  bool below = off > 0.0;
  uint side = below ? kBelow : kAbove;
  if ((here.a & side) == 0u) {
    below = !below;
    side = below ? kBelow : kAbove;
    part = -part;
  }
  ivec2 to_side = ivec2(0, below ? 1 : -1);
  bool has_side = (here.a & side) != 0u;
  vec3 change = has_side ? irradiance_of(texel_of(u_middles, tile + to_side)) - middle
                         : vec3(0.0);
  bool before = (here.a & kBefore) != 0u, after = (here.a & kAfter) != 0u;
  ivec2 to_before = ivec2(before ? -1 : 0, 0), to_after = ivec2(after ? 1 : 0, 0);
  uvec4 one = texel_of(u_middles, tile + to_before);
  uvec4 other = texel_of(u_middles, tile + to_after);
  vec3 one_change = change, other_change = change;
  if ((one.a & side) != 0u) {
    one_change = irradiance_of(texel_of(u_middles, tile + to_before + to_side)) -
                 irradiance_of(one);
  }
  if ((other.a & side) != 0u) {
    other_change = irradiance_of(texel_of(u_middles, tile + to_after + to_side)) -
                   irradiance_of(other);
  }
  vec3 column = middle + part * change;
  vec3 to_one = irradiance_of(one) + part * one_change - column;
  vec3 to_other = irradiance_of(other) + part * other_change - column;
  if (!before) to_one = -to_other;
  if (!after) to_other = -to_one;

  vec4 away = vec4(off_middle(at.x), off_middle(at.x + 1), off_middle(at.x + 2),
                   off_middle(at.x + 3));
  vec4 towards_one = max(-away, 0.0), towards_other = max(away, 0.0);
  o_red = max(column.r + towards_one * to_one.r + towards_other * to_other.r, 0.0);
  o_green = max(column.g + towards_one * to_one.g + towards_other * to_other.g, 0.0);
  o_blue = max(column.b + towards_one * to_one.b + towards_other * to_other.b, 0.0);
}
