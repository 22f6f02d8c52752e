// SPDX-License-Identifier: MIT
// Irradiance where tiles are not smooth: each light gives what it gives to this very point, were
// nothing between, as far as it is seen from its share's pixels around on the same surface. With
// AMID_PLANE these are all on it and face what the point does.
#include "shaders/interleaved_quads.glsl"
#include "shaders/interleaved_masks.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform bool u_first_round;                // there is nothing yet
uniform float u_plane_distance;            // as far off is another surface

Point point_at(ivec2 at) {
  at = min(at, textureSize(u_points, 0) - 1);
  uvec4 bits = texelFetch(u_points, at, 0);
  return Point(uintBitsToFloat(bits.xyz), unpack_unit(bits.w),
               unpack_unit(texelFetch(u_reflectances, at, 0).w));
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
/// 0 for a point on the surface of p, else how little it is like one that is.
float strangeness(Point p, Point other) {
  // Beyond 30 degrees it is another side of things.
  const float kOtherSide = 0.866;
  float alike = dot(p.shading, other.shading);
  float off = abs(dot(p.geometric, other.position - p.position)) / u_plane_distance;
  return alike > kOtherSide && off < 1.0 ? 0.0 : 1.0 - alike + 0.01 * off;
}

/// As near witnesses are they count.
float nearness_of(Point p, Point other) {
  vec3 way = (other.position - p.position) / u_plane_distance;
  return 1.0 / (dot(way, way) + 1e-8);
}

/// What a pixel of a share knows of its lights.
struct Witness {
  Point point;           // without normals if there is none
  uint seen;             // bits of lights
  vec4 strange, weight;  // to each of the pixels
};

Witness witness(ivec2 at, Pixels pixels) {
  Witness w;
  w.point = Point(vec3(0.0), vec3(0.0), vec3(0.0));
  w.seen = 0u;
  w.strange = vec4(1e30);
  w.weight = vec4(0.0);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, textureSize(u_points, 0)))) return w;
  if (texelFetch(u_points, at, 0) == uvec4(0u)) return w;  // the sky
  w.point = point_at(at);
  w.seen = mask_at(place_among_shares(at, textureSize(u_masks, 0)));
  w.strange = vec4(strangeness(pixels.p0, w.point), strangeness(pixels.p1, w.point),
                   strangeness(pixels.p2, w.point), strangeness(pixels.p3, w.point));
  w.weight = vec4(nearness_of(pixels.p0, w.point), nearness_of(pixels.p1, w.point),
                  nearness_of(pixels.p2, w.point), nearness_of(pixels.p3, w.point));
  return w;
}

/// Its weight where it is not too strange.
vec4 heard(Witness w, vec4 least) { return w.weight * vec4(lessThanEqual(w.strange, least)); }

/// Whether the light could be seen, were nothing between.
float faces(Witness w, Light light) {
  return dot(w.point.geometric, way_to(light, w.point)) > 0.0 ? 1.0 : 0.0;
}
#endif

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy));
  Pixels pixels = Pixels(point_at(at), point_at(at + ivec2(1, 0)), point_at(at + ivec2(2, 0)),
                         point_at(at + ivec2(3, 0)));
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
#if !AMID_PLANE
  vec4 told = vec4(0.0), untold = vec4(0.0);  // of what lights give, were nothing between
#endif
  for (int share = 0; share < TILE * TILE; ++share) {
    uvec2 lights = texelFetch(u_lights_of, ivec2(share, 0), 0).rg;
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
    for (int i = 0; i < count; ++i) {
      Light light = u_lights[first + i];
#if AMID_PLANE
      vec4 see = vec4(bit(seen_by, i));
      vec4 seen =
          sharpened(see.x * a.weight + see.y * b.weight + see.z * c.weight + see.w * d.weight);
#else
      vec4 can = vec4(faces(a, light), faces(b, light), faces(c, light), faces(d, light));
      vec4 do_see = can * vec4(bit(seen_by, i));
      vec4 could = can.x * hear_a + can.y * hear_b + can.z * hear_c + can.w * hear_d;
      vec4 seen = do_see.x * hear_a + do_see.y * hear_b + do_see.z * hear_c + do_see.w * hear_d;
      seen = sharpened(seen / max(could, 1e-30));
      // Of what these cannot tell the others may.
      bool any_sees = any(greaterThan(do_see, vec4(0.0)));
      seen = mix(vec4(any_sees), seen, vec4(greaterThan(could, vec4(0.0))));
#endif
      vec3 e0 = irradiance_from(light, pixels.p0), e1 = irradiance_from(light, pixels.p1);
      vec3 e2 = irradiance_from(light, pixels.p2), e3 = irradiance_from(light, pixels.p3);
      sum0 += seen.x * e0;
      sum1 += seen.y * e1;
      sum2 += seen.z * e2;
      sum3 += seen.w * e3;
#if !AMID_PLANE
      bool none_can = all(equal(can, vec4(0.0)));
      vec4 all_of_it = vec4(brightness(e0), brightness(e1), brightness(e2), brightness(e3));
      told += none_can ? vec4(0.0) : all_of_it;
      untold += none_can ? all_of_it : vec4(0.0);
#endif
    }
  }
#if !AMID_PLANE
  // Of lights that nobody could see as much is seen as of the others.
  vec4 more = 1.0 + untold / max(told, 1e-30);
  sum0 *= more.x;
  sum1 *= more.y;
  sum2 *= more.z;
  sum3 *= more.w;
#endif
  o_red = vec4(sum0.r, sum1.r, sum2.r, sum3.r);
  o_green = vec4(sum0.g, sum1.g, sum2.g, sum3.g);
  o_blue = vec4(sum0.b, sum1.b, sum2.b, sum3.b);
  if (u_first_round) return;
  o_red += texelFetch(u_red, ivec2(gl_FragCoord.xy), 0);
  o_green += texelFetch(u_green, ivec2(gl_FragCoord.xy), 0);
  o_blue += texelFetch(u_blue, ivec2(gl_FragCoord.xy), 0);
}
