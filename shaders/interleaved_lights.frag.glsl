// SPDX-License-Identifier: MIT
// Irradiance where tiles are not smooth: each light gives what it gives to this very point, were
// nothing between, as far as it is seen from its share's pixels around on the same surface.
#include "shaders/interleaved_quads.glsl"
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform highp usampler2D u_shares;         // alpha: bits of the lights that would give something
uniform sampler2D u_masks;                 // bits of those that are seen
uniform highp usampler2D u_lights_of;      // of each share the first and how many
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform bool u_first_lights;               // there is nothing yet
uniform float u_plane_distance;            // as far off is another surface

Point point_at(ivec2 at) {
  at = min(at, textureSize(u_points, 0) - 1);
  uvec4 bits = texelFetch(u_points, at, 0);
  return Point(uintBitsToFloat(bits.xyz), unpack_unit(bits.w),
               unpack_unit(texelFetch(u_reflectances, at, 0).w));
}

uint mask_at(ivec2 place) {
  uvec4 bytes = uvec4(texelFetch(u_masks, place, 0) * 255.0 + 0.5);
  return bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
}

/// The pixels that are shaded.
struct Pixels {
  Point p0, p1, p2, p3;
};

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

/// What a pixel of a share knows of its lights, as bits.
struct Witness {
  uint lit;  // they would give something to it
  uint seen;
  vec4 strange, near;  // to each of the pixels
};

Witness witness(ivec2 at, Pixels pixels) {
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, textureSize(u_points, 0)))) {
    return Witness(0u, 0u, vec4(1e30), vec4(0.0));
  }
  bool is_sky = texelFetch(u_points, at, 0) == uvec4(0u);
  ivec2 place = (at % TILE) * (textureSize(u_shares, 0) / TILE) + at / TILE;
  uint lit = is_sky ? 0u : texelFetch(u_shares, place, 0).a;
  Point other = point_at(at);
  return Witness(lit, lit & mask_at(place),
                 vec4(strangeness(pixels.p0, other), strangeness(pixels.p1, other),
                      strangeness(pixels.p2, other), strangeness(pixels.p3, other)),
                 vec4(nearness_of(pixels.p0, other), nearness_of(pixels.p1, other),
                      nearness_of(pixels.p2, other), nearness_of(pixels.p3, other)));
}

/// All bits where the witness is not too strange.
uvec4 heard(Witness w, vec4 least) { return uvec4(lessThanEqual(w.strange, least)) * 0xffffffffu; }

vec4 bit(uvec4 bits, int i) { return vec4((bits >> uint(i)) & 1u); }

void main() {
  ivec2 at = first_pixel_of(ivec2(gl_FragCoord.xy));
  Pixels pixels = Pixels(point_at(at), point_at(at + ivec2(1, 0)), point_at(at + ivec2(2, 0)),
                         point_at(at + ivec2(3, 0)));
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
  for (int share = 0; share < TILE * TILE; ++share) {
    uvec2 lights = texelFetch(u_lights_of, ivec2(share, 0), 0).rg;
    int first = int(lights.x), count = int(lights.y);
    // Its pixels around: in two columns and two rows.
    int x0 = at.x - TILE / 2, y1 = at.y + TILE;
    x0 += (share % TILE - x0) & (TILE - 1);
    y1 -= (at.y - share / TILE) & (TILE - 1);
    int x1 = x0 + TILE, y0 = y1 - TILE;
    Witness a = witness(ivec2(x0, y0), pixels), b = witness(ivec2(x1, y0), pixels);
    Witness c = witness(ivec2(x0, y1), pixels), d = witness(ivec2(x1, y1), pixels);
    vec4 least = min(min(a.strange, b.strange), min(c.strange, d.strange));
    uvec4 hear_a = heard(a, least), hear_b = heard(b, least);
    uvec4 hear_c = heard(c, least), hear_d = heard(d, least);
    uvec4 lit_a = hear_a & a.lit, lit_b = hear_b & b.lit, lit_c = hear_c & c.lit;
    uvec4 lit_d = hear_d & d.lit, seen_a = hear_a & a.seen, seen_b = hear_b & b.seen;
    uvec4 seen_c = hear_c & c.seen, seen_d = hear_d & d.seen;
    // Of what these cannot tell the others may; what nobody could see is seen.
    uint any_seen = a.seen | b.seen | c.seen | d.seen | ~(a.lit | b.lit | c.lit | d.lit);
    uvec4 others = any_seen & ~(lit_a | lit_b | lit_c | lit_d);
    for (int i = 0; i < count; ++i) {
      Light light = u_lights[first + i];
      vec4 lit = a.near * bit(lit_a, i) + b.near * bit(lit_b, i) + c.near * bit(lit_c, i) +
                 d.near * bit(lit_d, i);
      vec4 seen = a.near * bit(seen_a, i) + b.near * bit(seen_b, i) + c.near * bit(seen_c, i) +
                  d.near * bit(seen_d, i);
      // Shadows have edges: what most say counts for more.
      seen = clamp(2.0 * seen / max(lit, 1e-30) - 0.5, 0.0, 1.0) + bit(others, i);
      sum0 += seen.x * irradiance_from(light, pixels.p0);
      sum1 += seen.y * irradiance_from(light, pixels.p1);
      sum2 += seen.z * irradiance_from(light, pixels.p2);
      sum3 += seen.w * irradiance_from(light, pixels.p3);
    }
  }
  o_red = vec4(sum0.r, sum1.r, sum2.r, sum3.r);
  o_green = vec4(sum0.g, sum1.g, sum2.g, sum3.g);
  o_blue = vec4(sum0.b, sum1.b, sum2.b, sum3.b);
  if (u_first_lights) return;
  o_red += texelFetch(u_red, ivec2(gl_FragCoord.xy), 0);
  o_green += texelFetch(u_green, ivec2(gl_FragCoord.xy), 0);
  o_blue += texelFetch(u_blue, ivec2(gl_FragCoord.xy), 0);
}
