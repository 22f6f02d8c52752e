// SPDX-License-Identifier: MIT
// Adds the irradiance of a round's lights in the middles of flat tiles, four of a row a fragment.
// Each light is seen as its share's pixels around say, those of the tile and of its neighbours.
#include "shaders/colour_quads_out.glsl"
#include "shaders/interleaved.glsl"
#include "shaders/interleaved_masks.glsl"
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_tiles;  // see shaders/interleaved_tiles.frag.glsl
uniform highp usampler2D u_joins;  // see shaders/interleaved_joins.frag.glsl
uniform sampler2D u_red, u_green, u_blue, u_changes;  // what there is
uniform bool u_first_round;                           // there is nothing yet

// What the lights give, in sum of colours, of which the tile and its neighbour do not see the same.
layout(location = 3) out vec4 o_changes;

Point middle_of(ivec2 tile) {
  uvec4 plane = texel_of(u_tiles, min(tile, textureSize(u_tiles, 0) - 1));
  vec3 normal = unpack_unit(plane.w);
  return Point(uintBitsToFloat(plane.xyz), normal, normal);
}

uint joins_of(ivec2 tile) {
  return texel_of(u_joins, min(tile, textureSize(u_joins, 0) - 1)).r;
}

uvec4 where_joined(uvec4 joins, uint side) {
  return uvec4(notEqual(joins & side, uvec4(0u))) * 0xffffffffu;
}

void main() {
  ivec2 quad = ivec2(gl_FragCoord.xy), first = ivec2(4 * quad.x, quad.y);
  Point p0 = middle_of(first), p1 = middle_of(first + ivec2(1, 0));
  Point p2 = middle_of(first + ivec2(2, 0)), p3 = middle_of(first + ivec2(3, 0));
  uvec4 joins = uvec4(joins_of(first), joins_of(first + ivec2(1, 0)),
                      joins_of(first + ivec2(2, 0)), joins_of(first + ivec2(3, 0)));
  ivec2 share_size = textureSize(u_masks, 0) / TILE;
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
  vec4 changes = vec4(0.0);
  int share = 0;
  do {
    uvec2 lights = texel_of(u_lights_of, ivec2(share, 0)).rg;
    int first_light = int(lights.x), count = int(lights.y);
    ivec2 of_share = ivec2(share % TILE, share / TILE), corner = of_share * share_size;
    // The middle is between the share's pixel and one of its neighbours on either axis.
    bool is_before = of_share.x < TILE / 2, is_above = of_share.y < TILE / 2;
    int x = first.x - (is_before ? 0 : 1), y = first.y + (is_above ? 1 : -1);
    y = corner.y + clamp(y, 0, share_size.y - 1);
    uint m0 = mask_at(corner + ivec2(max(x, 0), first.y));
    uint m1 = mask_at(corner + ivec2(x + 1, first.y)), m2 = mask_at(corner + ivec2(x + 2, first.y));
    uint m3 = mask_at(corner + ivec2(x + 3, first.y));
    uint m4 = mask_at(corner + ivec2(min(x + 4, share_size.x - 1), first.y));
    uvec4 low = uvec4(m0, m1, m2, m3), high = uvec4(m1, m2, m3, m4);
    uvec4 own = is_before ? low : high, beside = is_before ? high : low;
    int column = corner.x + first.x;
    uvec4 over = uvec4(mask_at(ivec2(column, y)), mask_at(ivec2(column + 1, y)),
                       mask_at(ivec2(column + 2, y)), mask_at(ivec2(column + 3, y)));
    uvec4 joined = where_joined(joins, is_before ? kAfter : kBefore);
    beside = (beside & joined) | (own & ~joined);
    joined = where_joined(joins, is_above ? kBelow : kAbove);
    over = (over & joined) | (own & ~joined);
    vec2 away = abs(vec2(off_middle(of_share.x), off_middle(of_share.y)));
    uint left = seen_by_any(own | beside | over, count);
    if (left != 0u) {
      do {
        int i = number_of(lowest(left));
        Light light = u_lights[first_light + i];
        vec4 seen_here = vec4(bit(own, i)), seen_beside = vec4(bit(beside, i));
        vec4 seen_over = vec4(bit(over, i));
        vec4 to_beside = seen_beside - seen_here, to_over = seen_over - seen_here;
        vec4 seen = seen_here + away.x * to_beside + away.y * to_over;
        vec3 e0 = irradiance_from(light, p0), e1 = irradiance_from(light, p1);
        vec3 e2 = irradiance_from(light, p2), e3 = irradiance_from(light, p3);
        sum0 += seen.x * e0;
        sum1 += seen.y * e1;
        sum2 += seen.z * e2;
        sum3 += seen.w * e3;
        changes += (abs(to_beside) + abs(to_over)) *
                   vec4(brightness(e0), brightness(e1), brightness(e2), brightness(e3));
        left ^= lowest(left);
      } while (left != 0u);
    }
  } while (++share < TILE * TILE);
  write_quad(sum0, sum1, sum2, sum3);
  o_changes = changes;
  if (u_first_round) return;
  o_red += texel_of(u_red, quad);
  o_green += texel_of(u_green, quad);
  o_blue += texel_of(u_blue, quad);
  o_changes += texel_of(u_changes, quad);
}
