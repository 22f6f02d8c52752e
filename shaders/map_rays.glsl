// SPDX-License-Identifier: MIT
// Where maps leave it open which lights a pixel sees, the rays to them are met with the triangles
// that the four texels around name: edges of shadows are those of triangles, not of texels. [Lecocq
// et al. 2014, Sub-pixel Shadow Mapping]
#include "shaders/hash.glsl"
#include "shaders/map_receivers.glsl"
#include "shaders/shadow_maps.glsl"
#include "shaders/texel.glsl"
#include "shaders/triangles.glsl"

uniform highp usampler2D u_map_numbers;
uniform highp sampler2D u_triangles;

vec2 number_texel;
Rows triangle_rows;

void begin_rays() {
  number_texel = texel_size(u_map_numbers);
  triangle_rows = rows_of(textureSize(u_triangles, 0));
}

/// Beyond its border an octahedron goes on at the same border, mirrored. Half of one ends there,
/// and no block lies beyond.
ivec2 wrapped_texel(ivec2 texel) {
#if KIND == 0
  return texel;
#endif
  ivec2 inside = clamp(texel, ivec2(0), ivec2(map_size - 1));
  if (inside.x != texel.x) return ivec2(inside.x, map_size - 1 - inside.y);
  if (inside.y != texel.y) return ivec2(map_size - 1 - inside.x, inside.y);
  return inside;
}

/// What is left to ask of a light whose map does not tell by itself.
struct Question {
  vec3 way;
  float reach;      // see MapPoint
  uvec4 triangles;  // what the four texels around see that may be in the way
  uvec4 edges;      // whose edges are there before that
  uvec4 left, edges_left;  // of these
  uint nearest;     // what the texel sees in which the point is
  uint next, last;  // the triangle beyond an edge of the last one, which is asked first, unless 0
  int steps;        // that it is away from a texel's
};

// Mouldings are so many strips; few rays go that far before they pass by a rim.
const int kMostSteps = 8;

/// What a texel sees, and whose edge or what behind a veil; 0 for what is not in the way of any
/// light.
uvec2 seen_in(ivec2 corner, ivec2 texel, bool is_nearest, Receiver p) {
  uvec2 seen = texel_of(u_map_numbers, number_texel, corner + wrapped_texel(texel)).xy;
  bvec2 is_own = lessThan((seen & kNumber) - p.first, uvec2(p.count));
  // What has holes stops what goes through this very texel.
  bvec2 is_of_texel = equal(seen & (kHoles | kVeil), uvec2(kHoles));
  if (is_own.x || (is_of_texel.x && !is_nearest)) seen.x = 0u;
  if (is_own.y || (is_of_texel.y && !is_nearest)) seen.y = 0u;
  return seen;
}

Question question_for(int light, Receiver p) {
  LightMap map = map_of(light);
  Question asked;
  asked.way = way_to(map, p.position);
  MapPoint at = find_in_map(map, p.position, asked.way);
  asked.reach = at.reach;
  ivec2 first = block_of(at.texel), corner = corner_of_map(light);
  ivec2 off = clamp(ivec2(floor(at.texel)) - first, 0, 1);
  int nearest = off.x + 2 * off.y;
  uvec2 seen_x = seen_in(corner, first, nearest == 0, p);
  uvec2 seen_y = seen_in(corner, first + ivec2(1, 0), nearest == 1, p);
  uvec2 seen_z = seen_in(corner, first + ivec2(0, 1), nearest == 2, p);
  uvec2 seen_w = seen_in(corner, first + ivec2(1, 1), nearest == 3, p);
  uvec4 seen = uvec4(seen_x.x, seen_y.x, seen_z.x, seen_w.x);
  uvec4 edges = uvec4(seen_x.y, seen_y.y, seen_z.y, seen_w.y);
  asked.nearest = nearest == 0 ? seen.x : nearest == 1 ? seen.y : nearest == 2 ? seen.z : seen.w;
  // Each once.
  if (seen.y == seen.x) seen.y = 0u;
  if (seen.z == seen.x || seen.z == seen.y) seen.z = 0u;
  if (seen.w == seen.x || seen.w == seen.y || seen.w == seen.z) seen.w = 0u;
  uvec4 numbers = seen & kNumber, others = edges & kNumber;
  if (any(equal(others.xxxx, numbers))) edges.x = 0u;
  if (others.y == others.x || any(equal(others.yyyy, numbers))) edges.y = 0u;
  if (any(equal(others.zz, others.xy)) || any(equal(others.zzzz, numbers))) edges.z = 0u;
  if (any(equal(others.www, others.xyz)) || any(equal(others.wwww, numbers))) edges.w = 0u;
  asked.triangles = asked.left = seen;
  asked.edges = asked.edges_left = edges;
  asked.next = 0u;
  return asked;
}

bool is_answered(Question open) {
  uvec4 left = open.left | open.edges_left;
  return (left.x | left.y | left.z | left.w | open.next) == 0u;
}

/// One that is not 0, if any is, which is so from now on.
uint taken(inout uvec4 left) {
  uint one = 0u;
  if (left.x != 0u) {
    one = left.x;
    left.x = 0u;
  } else if (left.y != 0u) {
    one = left.y;
    left.y = 0u;
  } else if (left.z != 0u) {
    one = left.z;
    left.z = 0u;
  } else {
    one = left.w;
    left.w = 0u;
  }
  return one;
}

/// The next of the triangles that may be in the way.
uint next_of(inout Question open) {
  uint next = open.next;
  if (next != 0u) {
    open.next = 0u;
    ++open.steps;
    return next;
  }
  open.steps = 0;
  open.last = 0u;
  uint one = taken(open.left);
  return one != 0u ? one : taken(open.edges_left);
}

/// Whether a veil stops this ray: every ray has its own chance.
bool stops(float coverage, uint triangle, vec3 way, vec3 position) {
  uvec3 from = floatBitsToUint(position), to = floatBitsToUint(way);
  uint random = hash(hash(hash(triangle ^ from.x) ^ from.y) ^ from.z);
  random = hash(hash(hash(random ^ to.x) ^ to.y) ^ to.z);
  return float(random >> 8) * (1.0 / 16777216.0) < coverage;
}

/// Whether the next triangle is in the way. [Möller & Trumbore 1997] Behind the edge that the ray
/// passes by one may be that is too slender for texels.
bool is_in_way(inout Question open, Receiver p) {
  uint seen = next_of(open), number = seen & kNumber;
  vec3 way = open.way;
  vec4 a = corner_of(u_triangles, triangle_rows, number - 1u, 0);
  vec4 b = corner_of(u_triangles, triangle_rows, number - 1u, 1);
  vec4 c = corner_of(u_triangles, triangle_rows, number - 1u, 2);
  vec3 ab = b.xyz - a.xyz, ac = c.xyz - a.xyz, from_a = p.position - a.xyz;
  vec3 across = cross(way, ac), turned = cross(from_a, ab);
  float volume = dot(ab, across), part = 1.0 / volume;
  float v_of_b = dot(from_a, across) * part, v_of_c = dot(way, turned) * part;
  float t = dot(ac, turned) * part;
  float v_of_a = 1.0 - v_of_b - v_of_c;
  // Rays along a shared edge must not slip through: rounding.
  const float kSeam = 1e-5;
  float least = min(v_of_a, min(v_of_b, v_of_c));
  bool is_before = t > 0.0 && (KIND == 2 || t < 1.0);
  bool is_hit = is_before && least >= -kSeam;
  if ((seen & kVeil) != 0u) return is_hit && stops(a.w, number, way, p.position);
  if (is_hit) return true;
  // What has holes stops what goes through its texel. A triangle that is smaller than a texel
  // stands for others like it, which rays do not find: leaves, gravel.
  bool has_holes = (seen & kHoles) != 0u;
  float size = 0.65 * open.reach;  // half of it is a texel's diagonal
  vec3 bc = ac - ab;
  float longest = max(dot(ab, ab), max(dot(ac, ac), dot(bc, bc)));
  bool is_tiny = open.steps == 0 && seen == open.nearest && longest < size * size;
  if (has_holes || is_tiny) {
    float slope = dot(way, way) / max(dot(p.geometric, way), 1e-6);
    if (-dot(from_a, way) > open.reach * slope) return true;
    if (has_holes) return false;
  }
  bool may_step = is_before && open.steps < kMostSteps && volume != 0.0;
  if (!may_step) return false;
  // Folded back under the last one: the ray passes by the rim of the mesh.
  float to_last = open.last == uint(a.w) ? v_of_c : open.last == uint(b.w) ? v_of_a : v_of_b;
  if (open.steps > 0 && to_last < 0.0) return false;
  // The texels' triangles are asked anyhow.
  uint next = uint(least == v_of_a ? b.w : least == v_of_b ? c.w : a.w);
  bool is_asked = any(equal(open.triangles, uvec4(next))) || any(equal(open.edges, uvec4(next)));
  bool is_own = next - p.first < p.count;
  open.next = is_asked || is_own ? 0u : next;
  open.last = number;
  return false;
}

/// Whether a light is seen.
bool sees(int light, Receiver p) {
  Question open = question_for(light, p);
  bool shadowed = false;
  for (;;) {
    shadowed = !is_answered(open) && is_in_way(open, p);
    if (shadowed || is_answered(open)) return !shadowed;
  }
}
