// SPDX-License-Identifier: MIT
// Irradiance where tiles are not smooth: each light gives what it gives to this very point, were
// nothing between, as far as it is seen from its share's pixels around on the same surface. With
// AMID_PLANE these are all on it and face what the point does.
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
  Point p0, p1, p2, p3;
};

// Shadows have edges: what most say counts for more.
vec4 sharpened(vec4 seen) { return clamp(2.0 * seen - 0.5, 0.0, 1.0); }

#if AMID_PLANE
/// What a pixel of a share knows of its lights.
struct Witness {
  uint seen;    // bits of lights
  vec4 weight;  // for each of the pixels: 1 / distance²
};

Witness witness(ivec2 at, ivec2 first) {
  vec4 dx = float(first.x - at.x) + vec4(0.0, 1.0, 2.0, 3.0);
  float dy = float(first.y - at.y);
  return Witness(mask_at(place_among_shares(at, textureSize(u_masks, 0))),
                 1.0 / (dx * dx + dy * dy + 1e-6));
}
#else
/// What a pixel of a share knows of its lights.
struct Witness {
  vec3 normal;           // geometric; 0 if there is no surface
  float height;          // along it
  uint seen;             // bits of lights
  vec4 strange, weight;  // to each of the pixels
};

/// How strange a point is to p: 0 on its surface, else how little it is like one that is; and what
/// it counts, 1 / distance².
vec2 strange_and_weight(Point p, vec3 other, vec3 normal) {
  // Beyond 30 degrees it is another side of things, however smooth it is shaded.
  const float kOtherSide = 0.866;
  vec3 way = other - p.position;
  float alike = dot(p.geometric, normal);
  float off = abs(dot(p.geometric, way)) / u_plane_distance;
  float nearest = 1e-4 * u_plane_distance;
  return vec2(alike > kOtherSide && off < 1.0 ? 0.0 : 1.0 - alike + 0.01 * off,
              1.0 / (dot(way, way) + nearest * nearest));
}

Witness witness(ivec2 at, Pixels pixels) {
  ivec2 inside = clamp(at, ivec2(0), textureSize(u_points, 0) - 1);
  uvec4 bits = texel_of(u_points, inside);
  vec3 point = uintBitsToFloat(bits.xyz), normal = unpack_unit(bits.w);
  vec2 to0 = strange_and_weight(pixels.p0, point, normal);
  vec2 to1 = strange_and_weight(pixels.p1, point, normal);
  vec2 to2 = strange_and_weight(pixels.p2, point, normal);
  vec2 to3 = strange_and_weight(pixels.p3, point, normal);
  bool is_none = inside != at || bits == uvec4(0u);  // or the sky
  Witness w;
  w.normal = is_none ? vec3(0.0) : normal;
  w.height = dot(w.normal, point);
  w.seen = mask_at(place_among_shares(inside, textureSize(u_masks, 0)));
  w.strange = is_none ? vec4(1e30) : vec4(to0.x, to1.x, to2.x, to3.x);
  w.weight = is_none ? vec4(0.0) : vec4(to0.y, to1.y, to2.y, to3.y);
  return w;
}

/// Its weight where it is not too strange.
vec4 heard(Witness w, vec4 least) { return w.weight * vec4(lessThanEqual(w.strange, least)); }

/// Whether the light could be seen, were nothing between.
bool faces(Witness w, Light light) {
#if KIND == 2
  return dot(w.normal, light.place.xyz) < 0.0;
#else
  return dot(w.normal, light.place.xyz) > w.height;
#endif
}
#endif

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy));
  ivec2 last = textureSize(u_points, 0) - 1;
  Pixels pixels =
      Pixels(point_at(min(at, last)), point_at(min(at + ivec2(1, 0), last)),
             point_at(min(at + ivec2(2, 0), last)), point_at(min(at + ivec2(3, 0), last)));
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
#if !AMID_PLANE
  // Of what lights give, were nothing between, where strangers are: what somebody could see, what
  // of it is seen, what nobody could.
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
    int x1 = x0 + TILE, y0 = y1 - TILE;
#if AMID_PLANE
    Witness a = witness(ivec2(x0, y0), at), b = witness(ivec2(x1, y0), at);
    Witness c = witness(ivec2(x0, y1), at), d = witness(ivec2(x1, y1), at);
    vec4 all_of_them = a.weight + b.weight + c.weight + d.weight;
    a.weight /= all_of_them;
    b.weight /= all_of_them;
    c.weight /= all_of_them;
    d.weight /= all_of_them;
#else
    Witness a = witness(ivec2(x0, y0), pixels), b = witness(ivec2(x1, y0), pixels);
    Witness c = witness(ivec2(x0, y1), pixels), d = witness(ivec2(x1, y1), pixels);
    vec4 least = min(min(a.strange, b.strange), min(c.strange, d.strange));
    vec4 hear_a = heard(a, least), hear_b = heard(b, least);
    vec4 hear_c = heard(c, least), hear_d = heard(d, least);
#endif
    uvec4 seen_by = uvec4(a.seen, b.seen, c.seen, d.seen);
#if AMID_PLANE
    uint left = seen_by_any(seen_by, count);
#else
    // Where one is on another surface the others may not face what a pixel does.
    vec4 most = max(max(a.strange, b.strange), max(c.strange, d.strange));
    bool are_strangers = any(greaterThan(most, vec4(0.0)));
    uint left = are_strangers ? lowest_bits(count) : seen_by_any(seen_by, count);
#endif
    if (left != 0u) {
      do {
        int i = number_of(lowest(left));
        Light light = u_lights[first + i];
#if AMID_PLANE
        vec4 see = vec4(bit(seen_by, i));
        vec4 seen =
            sharpened(see.x * a.weight + see.y * b.weight + see.z * c.weight + see.w * d.weight);
#else
        bvec4 faces_it = bvec4(faces(a, light), faces(b, light), faces(c, light), faces(d, light));
        uvec4 sees_it = bit(seen_by, i) & uvec4(faces_it);
        vec4 can = vec4(faces_it), do_see = vec4(sees_it);
        vec4 could = can.x * hear_a + can.y * hear_b + can.z * hear_c + can.w * hear_d;
        vec4 seen = do_see.x * hear_a + do_see.y * hear_b + do_see.z * hear_c + do_see.w * hear_d;
        seen = sharpened(seen / max(could, 1e-30));
        // Of what these cannot tell the others may.
        bool any_sees = (sees_it.x | sees_it.y | sees_it.z | sees_it.w) != 0u;
        seen = mix(vec4(any_sees), seen, vec4(greaterThan(could, vec4(0.0))));
#endif
        vec3 e0 = irradiance_from(light, pixels.p0), e1 = irradiance_from(light, pixels.p1);
        vec3 e2 = irradiance_from(light, pixels.p2), e3 = irradiance_from(light, pixels.p3);
        sum0 += seen.x * e0;
        sum1 += seen.y * e1;
        sum2 += seen.z * e2;
        sum3 += seen.w * e3;
#if !AMID_PLANE
        if (are_strangers) {
          vec4 gives = vec4(brightness(e0), brightness(e1), brightness(e2), brightness(e3));
          bool is_told = any(faces_it);
          told += is_told ? gives : vec4(0.0);
          told_seen += is_told ? seen * gives : vec4(0.0);
          untold += is_told ? vec4(0.0) : gives;
        }
#endif
        left ^= lowest(left);
      } while (left != 0u);
    }
  } while (++share < TILE * TILE);
#if !AMID_PLANE
  // Of lights that nobody could see as much is seen as of the others.
  vec4 sum = vec4(brightness(sum0), brightness(sum1), brightness(sum2), brightness(sum3));
  vec4 more = 1.0 + untold * told_seen / max(told * sum, 1e-30);
  sum0 *= more.x;
  sum1 *= more.y;
  sum2 *= more.z;
  sum3 *= more.w;
#endif
  write_quad(sum0, sum1, sum2, sum3);
  if (u_first_round) return;
  o_red += texel_of(u_red, ivec2(gl_FragCoord.xy));
  o_green += texel_of(u_green, ivec2(gl_FragCoord.xy));
  o_blue += texel_of(u_blue, ivec2(gl_FragCoord.xy));
}
