// SPDX-License-Identifier: MIT
// Irradiance where the surface is not flat: each light gives what it gives to this very point, were
// nothing between, if it is seen from its share's pixels around on the same surface.
#include "shaders/interleaved.glsl"
#include "shaders/lights.glsl"

uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform highp usampler2D u_shares;  // alpha: bits of the lights that would give something
uniform sampler2D u_masks;          // those that are seen
uniform sampler2D u_lights_of;      // a row for each share: 32 lights, how many there are
uniform sampler2D u_red, u_green, u_blue;  // what there is
uniform bool u_first_lights;

layout(location = 0) out vec4 o_red;
layout(location = 1) out vec4 o_green;
layout(location = 2) out vec4 o_blue;

Point point_at(ivec2 at) {
  uvec4 bits = texelFetch(u_points, at, 0);
  return Point(uintBitsToFloat(bits.xyz), unpack_unit(bits.w),
               unpack_unit(texelFetch(u_reflectances, at, 0).w));
}

uint mask_at(ivec2 place) {
  uvec4 bytes = uvec4(texelFetch(u_masks, place, 0) * 255.0 + 0.5);
  return bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
}

Light light_of(int share, int i) {
  return Light(texelFetch(u_lights_of, ivec2(3 * i, share), 0),
               texelFetch(u_lights_of, ivec2(3 * i + 1, share), 0),
               texelFetch(u_lights_of, ivec2(3 * i + 2, share), 0));
}

/// The pixels that are shaded.
struct Pixels {
  Point p0, p1, p2, p3;
};

uint same_surface(Point p, Point other) {
  // Beyond 30 degrees it is another side of things.
  const float kOtherSide = 0.866;
  bool same = abs(dot(p.geometric, other.position - p.position)) < u_plane_distance &&
              dot(p.shading, other.shading) > kOtherSide;
  return same ? 0xffffffffu : 0u;
}

/// What a pixel of a share knows of its lights, as bits.
struct Witness {
  uint lit;   // they would give something to it
  uint seen;
  uvec4 own;  // lit, to those of the pixels whose surface it is on
};

Witness witness(ivec2 at, Pixels pixels) {
  ivec2 size = textureSize(u_points, 0);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
    return Witness(0u, 0u, uvec4(0u));
  }
  ivec2 place = (at % TILE) * (textureSize(u_shares, 0) / TILE) + at / TILE;
  uint lit = texelFetch(u_shares, place, 0).a;
  Point other = point_at(at);
  uvec4 same = uvec4(same_surface(pixels.p0, other), same_surface(pixels.p1, other),
                     same_surface(pixels.p2, other), same_surface(pixels.p3, other));
  return Witness(lit, mask_at(place), uvec4(lit) & same);
}

/// Lights that nobody has told of yet, and those that are seen.
struct Told {
  uvec4 open, seen;
};

Told ask(Told told, uvec4 who, uvec4 seen) {
  return Told(told.open & ~who, told.seen | (told.open & who & seen));
}

uvec4 choose(uvec4 which, uvec4 a, uvec4 b) { return (a & ~which) | (b & which); }

/// The lights that the pixels see: by the nearest witness, a or (where `which` has bits) b; else by
/// one further away, else by one on another surface. What nobody could see is seen.
uvec4 seen_lights(uvec4 which, Witness a, Witness b, Witness far_a, Witness far_b) {
  Told told = Told(uvec4(0xffffffffu), uvec4(0u));
  told = ask(told, choose(which, a.own, b.own), choose(which, uvec4(a.seen), uvec4(b.seen)));
  told = ask(told, choose(which, b.own, a.own), choose(which, uvec4(b.seen), uvec4(a.seen)));
  told = ask(told, far_a.own, uvec4(far_a.seen));
  told = ask(told, far_b.own, uvec4(far_b.seen));
  told = ask(told, uvec4(a.lit), uvec4(a.seen));
  told = ask(told, uvec4(b.lit), uvec4(b.seen));
  told = ask(told, uvec4(far_a.lit), uvec4(far_a.seen));
  told = ask(told, uvec4(far_b.lit), uvec4(far_b.seen));
  return told.seen | told.open;
}

uvec4 bits(bvec4 b) { return uvec4(b) * 0xffffffffu; }

void main() {
  ivec2 at = ivec2(kColumns, 1) * ivec2(gl_FragCoord.xy);
  Pixels pixels = Pixels(point_at(at), point_at(at + ivec2(1, 0)), point_at(at + ivec2(2, 0)),
                         point_at(at + ivec2(3, 0)));
  vec3 sum0 = vec3(0.0), sum1 = vec3(0.0), sum2 = vec3(0.0), sum3 = vec3(0.0);
  for (int share = 0; share < TILE * TILE; ++share) {
    int count = int(texelFetch(u_lights_of, ivec2(96, share), 0).r);
    ivec2 first = at - ivec2(TILE / 2, 0);
    int left = first.x + ((share % TILE - first.x) & (TILE - 1)), right = left + TILE;
    int up = (at.y - share / TILE) & (TILE - 1), down = TILE - up;  // so far away
    int near = up <= down ? at.y - up : at.y + down, far = up <= down ? at.y + down : at.y - up;
    Witness a = witness(ivec2(left, near), pixels), b = witness(ivec2(right, near), pixels);
    Witness far_a = witness(ivec2(left, far), pixels), far_b = witness(ivec2(right, far), pixels);
    // Between two that are as far away half of what each tells counts.
    ivec4 x = at.x + ivec4(0, 1, 2, 3);
    ivec4 to_left = abs(x - left), to_right = abs(x - right);
    uvec4 seen = seen_lights(bits(greaterThan(to_left, to_right)), a, b, far_a, far_b);
    uvec4 or_seen = bits(greaterThanEqual(to_left, to_right));
    or_seen = up == down ? seen_lights(or_seen, far_a, far_b, a, b)
                         : seen_lights(or_seen, a, b, far_a, far_b);
    for (int i = 0; i < count; ++i) {
      Light light = light_of(share, i);
      vec4 weight = 0.5 * vec4(((seen >> uint(i)) & 1u) + ((or_seen >> uint(i)) & 1u));
      sum0 += weight.x * irradiance_from(light, pixels.p0);
      sum1 += weight.y * irradiance_from(light, pixels.p1);
      sum2 += weight.z * irradiance_from(light, pixels.p2);
      sum3 += weight.w * irradiance_from(light, pixels.p3);
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
