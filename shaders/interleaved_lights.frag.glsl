// SPDX-License-Identifier: MIT
// Irradiance where tiles are not smooth: each light gives what it gives to this very point, were
// nothing between, as far as it is seen from its share's pixels around on the same surface. With
// AMID_PLANE these are all on it; else the shares that have a pixel in the very row or column tell
// whether all see less or more there than around.
#include "shaders/colour_quads_out.glsl"
#include "shaders/interleaved.glsl"
#include "shaders/interleaved_masks.glsl"
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform bool u_first_round;                // there is nothing yet
uniform float u_plane_distance;            // as far off is another surface

Point point_at(ivec2 at) {
  uvec4 bits = texel_of(u_points, at);
  return Point(uintBitsToFloat(bits.xyz), unpack_unit(texel_of(u_reflectances, at).w),
               unpack_unit(bits.w));
}

/// The pixels that are shaded.
struct Pixels {
  ivec2 at;  // the first one's
  Point p0, p1, p2, p3;
};

/// A pixel of a share.
struct Witness {
  uint seen;     // bits of lights
  vec4 plane;    // geometric normal, and how far along it; 0 if there is no surface
  vec4 strange;  // to each of the pixels that are shaded: 0 if it is on their surface
  vec4 weight;   // 0 if there is none
};

/// How little another point is like one on p's surface, 0 if it is one; and what it counts,
/// 1 / distance².
vec2 strange_and_weight(Point p, vec3 other, vec3 normal) {
  // Beyond 30 degrees it is another side of things, however smooth it is shaded.
  const float kOtherSide = 0.866;
  vec3 way = other - p.position, turn = normal - p.geometric;
  float distance2 = dot(way, way), alike = dot(p.geometric, normal);
  // What is round bends away from its planes.
  float bent = sqrt(distance2 * dot(turn, turn));
  float off = max(abs(dot(p.geometric, way)) - bent, 0.0) / u_plane_distance;
  float nearest = 1e-2 * u_plane_distance;
  return vec2(alike > kOtherSide && off < 1.0 ? 0.0 : 1.0 - alike + 0.01 * off,
              1.0 / (distance2 + nearest * nearest));
}

Witness witness(ivec2 at, Pixels pixels) {
#if AMID_PLANE
  vec4 dx = float(pixels.at.x - at.x) + vec4(0.0, 1.0, 2.0, 3.0);
  float dy = float(pixels.at.y - at.y);
  return Witness(mask_at(place_among_shares(at, textureSize(u_masks, 0))), vec4(0.0), vec4(0.0),
                 1.0 / (dx * dx + dy * dy + 1e-6));
#else
  ivec2 inside = clamp(at, ivec2(0), textureSize(u_points, 0) - 1);
  uvec4 bits = texel_of(u_points, inside);
  if (inside != at || bits == uvec4(0u)) return Witness(0u, vec4(0.0), vec4(1e30), vec4(0.0));
  vec3 point = uintBitsToFloat(bits.xyz), normal = unpack_unit(bits.w);
  vec2 to0 = strange_and_weight(pixels.p0, point, normal);
  vec2 to1 = strange_and_weight(pixels.p1, point, normal);
  vec2 to2 = strange_and_weight(pixels.p2, point, normal);
  vec2 to3 = strange_and_weight(pixels.p3, point, normal);
  return Witness(mask_at(place_among_shares(at, textureSize(u_masks, 0))),
                 vec4(normal, dot(normal, point)), vec4(to0.x, to1.x, to2.x, to3.x),
                 vec4(to0.y, to1.y, to2.y, to3.y));
#endif
}

/// The pixels around of one share: for each of the pixels that are shaded those count that are
/// least strange to it.
struct Witnesses {
  uvec4 seen;
  bool are_strangers;  // some of them, to some of the pixels
  mat4 planes;
  vec4 a, b, c, d;  // weights, in sum 1, or 0 if there are none
};

Witnesses witnesses(ivec2 low, ivec2 high, Pixels pixels) {
  Witness a = witness(low, pixels), b = witness(ivec2(high.x, low.y), pixels);
  Witness c = witness(ivec2(low.x, high.y), pixels), d = witness(high, pixels);
  vec4 least = min(min(a.strange, b.strange), min(c.strange, d.strange));
  Witnesses w;
  w.seen = uvec4(a.seen, b.seen, c.seen, d.seen);
  vec4 most = max(max(a.strange, b.strange), max(c.strange, d.strange));
  w.are_strangers = any(greaterThan(most, vec4(0.0)));
  w.planes = mat4(a.plane, b.plane, c.plane, d.plane);
  w.a = a.weight * vec4(lessThanEqual(a.strange, least));
  w.b = b.weight * vec4(lessThanEqual(b.strange, least));
  w.c = c.weight * vec4(lessThanEqual(c.strange, least));
  w.d = d.weight * vec4(lessThanEqual(d.strange, least));
  vec4 sum = max(w.a + w.b + w.c + w.d, 1e-30);
  w.a /= sum;
  w.b /= sum;
  w.c /= sum;
  w.d /= sum;
  return w;
}

// Shadows have edges: what most say counts for more.
vec4 sharpened(vec4 seen) { return clamp(2.0 * seen - 0.5, 0.0, 1.0); }

#if !AMID_PLANE
/// Of the lights of some shares which any of the pixels around sees that count, for each of those
/// that are shaded.
struct Given {
  vec4 open;     // what they give, were nothing between: brightness
  vec4 seen;     // and what of it is seen
  vec4 squares;  // sum of the squares of what each gives
};

Given nothing() { return Given(vec4(0.0), vec4(0.0), vec4(0.0)); }

void add(inout Given sum, Given more, vec4 part) {
  sum.open += part * more.open;
  sum.seen += part * more.seen;
  sum.squares += part * more.squares;
}

/// How much more is seen than `all` say, by what `near` ones do: their difference, less what may be
/// chance, as they are other lights. [James & Stein 1961, whose estimator shrinks by variance /
/// difference²]
vec4 more_seen(Given all, Given near) {
  const float kNothing = 1e-15;
  vec4 open = max(near.open, kNothing), open_others = max(all.open - near.open, kNothing);
  vec4 seen = near.seen / open;
  vec4 difference = seen - (all.seen - near.seen) / open_others;
  // 1 / how many lights they are as good as.
  vec4 few = near.squares / (open * open);
  vec4 few_others = (all.squares - near.squares) / (open_others * open_others);
  // Of one light, seen or not. That all of a few are in shadow does not tell that others are.
  const float kOfFew = 4.0, kSure = 3.0;
  vec4 variance = seen * (1.0 - seen) + kOfFew * few;
  vec4 chance = kSure * variance * (few + few_others) / max(difference * difference, 1e-30);
  vec4 any_near = vec4(greaterThan(near.open, vec4(kNothing)));
  return any_near * max(1.0 - chance, 0.0) * difference * open_others / max(all.open, kNothing);
}

/// Which of them the light could be seen from, were nothing between.
vec4 facing(Witnesses w, Light light) {
#if KIND == 2
  return vec4(greaterThan(-(vec4(light.place.xyz, 0.0) * w.planes), vec4(0.0)));
#else
  return vec4(greaterThan(vec4(light.place.xyz, -1.0) * w.planes, vec4(0.0)));
#endif
}
#endif

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy));
  ivec2 last = textureSize(u_points, 0) - 1;
  Pixels pixels =
      Pixels(at, point_at(min(at, last)), point_at(min(at + ivec2(1, 0), last)),
             point_at(min(at + ivec2(2, 0), last)), point_at(min(at + ivec2(3, 0), last)));
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
#if !AMID_PLANE
  Given all = nothing(), row = nothing(), column = nothing();
  // Of what lights give, were nothing between, where strangers are: of which anybody tells, what of
  // it is seen, and of which nobody does.
  vec4 told = vec4(0.0), told_seen = vec4(0.0), untold = vec4(0.0);
#endif
  int share = 0;
  do {
    uvec2 lights = texel_of(u_lights_of, ivec2(share, 0)).rg;
    int first = int(lights.x), count = int(lights.y);
    // Its pixels around: in two columns and two rows.
    int x0 = at.x - TILE / 2, y1 = at.y + TILE;
    x0 += (share % TILE - x0) & (TILE - 1);
    y1 -= (at.y - share / TILE) & (TILE - 1);
    Witnesses w = witnesses(ivec2(x0, y1 - TILE), ivec2(x0 + TILE, y1), pixels);
#if !AMID_PLANE
    Given given = nothing();
#endif
    uint left = seen_by_any(w.seen, count);
#if !AMID_PLANE
    // On another surface they may not face what the pixels do.
    if (w.are_strangers) left = lowest_bits(count);
#endif
    if (left != 0u) {
      do {
        int i = number_of(lowest(left));
        Light light = u_lights[first + i];
        vec4 see = vec4(bit(w.seen, i));
#if AMID_PLANE
        vec4 seen = sharpened(see.x * w.a + see.y * w.b + see.z * w.c + see.w * w.d);
#else
        vec4 can = facing(w, light);
        see *= can;
        vec4 could = can.x * w.a + can.y * w.b + can.z * w.c + can.w * w.d;
        vec4 seen = see.x * w.a + see.y * w.b + see.z * w.c + see.w * w.d;
        vec4 is_seen = vec4(greaterThan(seen, vec4(0.0)));
        // Of what these cannot tell the others may.
        vec4 by_any = vec4(any(greaterThan(see, vec4(0.0))));
        seen = mix(by_any, sharpened(seen / max(could, 1e-30)), greaterThan(could, vec4(0.0)));
#endif
        vec3 e0 = irradiance_from(light, pixels.p0), e1 = irradiance_from(light, pixels.p1);
        vec3 e2 = irradiance_from(light, pixels.p2), e3 = irradiance_from(light, pixels.p3);
        sum0 += seen.x * e0;
        sum1 += seen.y * e1;
        sum2 += seen.z * e2;
        sum3 += seen.w * e3;
#if !AMID_PLANE
        vec4 open = vec4(brightness(e0), brightness(e1), brightness(e2), brightness(e3));
        if (w.are_strangers) {
          bool is_told = any(greaterThan(can, vec4(0.0)));
          told += is_told ? open : vec4(0.0);
          told_seen += is_told ? seen * open : vec4(0.0);
          untold += is_told ? vec4(0.0) : open;
        }
        open *= is_seen;
        given.open += open;
        given.seen += seen * open;
        given.squares += open * open;
#endif
        left ^= lowest(left);
      } while (left != 0u);
    }
#if !AMID_PLANE
    ivec4 columns = at.x + ivec4(0, 1, 2, 3);
    add(all, given, vec4(1.0));
    add(row, given, vec4(share / TILE == at.y % TILE));
    add(column, given, vec4(equal(columns % TILE, ivec4(share % TILE))));
#endif
  } while (++share < TILE * TILE);
#if !AMID_PLANE
  vec4 by_row = more_seen(all, row), by_column = more_seen(all, column);
  vec4 more = mix(by_row, by_column, greaterThan(abs(by_column), abs(by_row)));
  // Of lights of which nobody tells as much is seen as of the others.
  vec4 sum = vec4(brightness(sum0), brightness(sum1), brightness(sum2), brightness(sum3));
  vec4 seen = max(sum + more * all.open, 0.0) + untold * told_seen / max(told, 1e-30);
  vec4 factor = seen / max(sum, 1e-30);
  sum0 *= factor.x;
  sum1 *= factor.y;
  sum2 *= factor.z;
  sum3 *= factor.w;
#endif
  write_quad(sum0, sum1, sum2, sum3);
  if (u_first_round) return;
  o_red += texel_of(u_red, ivec2(gl_FragCoord.xy));
  o_green += texel_of(u_green, ivec2(gl_FragCoord.xy));
  o_blue += texel_of(u_blue, ivec2(gl_FragCoord.xy));
}
