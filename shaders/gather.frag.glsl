// SPDX-License-Identifier: MIT
// The irradiance that each element receives from a cluster of shooting elements, which lie in one
// plane: near it the sum of the elements' own form factors, farther away that of a disc. What the
// hemicube on the cluster sees decides whether anything is between. [Coombe, Harris & Lastra 2004]
#include "shaders/form_factor.glsl"
#include "shaders/hemicube.glsl"
#include "shaders/texel.glsl"

uniform sampler2D points;   // of the elements, several layers of rows
uniform sampler2D normals;  // w: exposed area
uniform sampler2D corners;  // three layers of rows
uniform sampler2D unshot;   // radiosity; w: exposed share of the element
uniform usampler2D items;
uniform sampler2D planes;     // of the world's triangles
// Their corners, three layers of rows; w: the first texel in `neighbours`, and how many.
uniform sampler2D triangles;
uniform sampler2D neighbours;  // four numbers plus 1, or 0
uniform int layers;  // of `points`
uniform int layer;   // the one to use

uniform vec3 origin;  // of the hemicube
uniform mat3 to_local;
uniform float tolerance;  // the part of its way beyond an occluder's plane that settles a shadow
uniform float hair;       // what counts as on a plane, in metres

uniform int first;  // the cluster's elements
uniform int count;
uniform vec3 centre;
uniform float area;
uniform vec3 radiosity;     // mean over the cluster
uniform float near_square;  // of the distance below which elements are summed

layout(location = 0) out vec4 irradiance;

ivec2 place_of(int i, ivec2 size) { return ivec2(i % size.x, i / size.x); }

/// Whether the segment from the origin goes through the triangle, whose plane it crosses.
bool is_met(int triangle, vec3 way) {
  ivec2 size = textureSize(planes, 0);
  ivec2 there = place_of(triangle, size);
  vec3 a = texel_of(triangles, there).xyz - origin;
  vec3 b = texel_of(triangles, there + ivec2(0, size.y)).xyz - origin;
  vec3 c = texel_of(triangles, there + ivec2(0, 2 * size.y)).xyz - origin;
  vec3 sides = vec3(dot(way, cross(a, b)), dot(way, cross(b, c)), dot(way, cross(c, a)));
  return all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
}

/// What the hemicube sees along a local direction: the number of a triangle, or -1.
int seen(vec3 local) {
  ivec2 pixel = hemicube_pixel(local, textureSize(items, 0).x);
  return int(texel_of(items, pixel).x & 0x7fffffffu) - 1;
}

/// How far the point lies beyond the plane of the triangle, in metres, and how far the origin lies on
/// this side of it. Exact for each element, so that nothing shadows itself, however flat the angle.
vec2 beyond(int triangle, vec3 point) {
  vec4 plane = texel_of(planes, place_of(triangle, textureSize(planes, 0)));
  float height = dot(plane.xyz, origin) + plane.w;
  return vec2(-sign(height) * (dot(plane.xyz, point) + plane.w), abs(height));
}

/// Whether what a pixel sees stands before the point by more than the pixel's size.
bool hides(int triangle, vec3 point) {
  if (triangle < 0) return false;
  vec2 depth = beyond(triangle, point);
  return depth.x > hair && depth.x > tolerance * (depth.x + depth.y);
}

bool is_between(int triangle, vec3 point, vec3 way) {
  return triangle >= 0 && beyond(triangle, point).x > hair && is_met(triangle, way);
}

/// Whether the triangle or one that touches it stands between: what no pixel sees, as the side of a
/// thin wall, lies beside what one sees.
bool is_between_or_beside(int triangle, vec3 point, vec3 way) {
  if (triangle < 0) return false;
  if (is_between(triangle, point, way)) return true;
  ivec2 size = textureSize(planes, 0);
  ivec2 there = place_of(triangle, size);
  int its_first = int(texel_of(triangles, there).w);
  int its_count = int(texel_of(triangles, there + ivec2(0, size.y)).w);
  int width = textureSize(neighbours, 0).x;
  for (int i = its_first; i < its_first + its_count; ++i) {
    ivec4 beside = ivec4(texel_of(neighbours, ivec2(i % width, i / width))) - 1;
    for (int k = 0; k < 4; ++k) {
      if (is_between(beside[k], point, way)) return true;
    }
  }
  return false;
}

/// The pixel on the way and those half a pixel beside it tell which triangles to ask. Where all see
/// something before the point it is in shadow; where an edge passes through the triangles
/// themselves decide, or shadows would grow by half a pixel.
bool is_lit(vec3 point, vec3 way, vec3 local) {
  vec3 a = abs(local);
  float most = max(a.x, max(a.y, a.z));
  vec3 d = local / most;
  float half_pixel = 1.0 / float(textureSize(items, 0).x);
  int around[5];
  around[4] = seen(local);
  bool hidden = hides(around[4], point);
  bool alike = true;
  for (int k = 0; k < 4; ++k) {
    float u = (k & 1) == 0 ? -half_pixel : half_pixel;
    float v = (k & 2) == 0 ? -half_pixel : half_pixel;
    vec3 tap = d + (a.z == most ? vec3(u, v, 0.0) : a.x == most ? vec3(0.0, u, v) : vec3(u, 0.0, v));
    around[k] = seen(vec3(tap.xy, max(tap.z, 0.0)));
    hidden = hidden && hides(around[k], point);
    alike = alike && around[k] == around[4];
  }
  if (hidden) return false;
  if (alike) return !is_between(around[4], point, way);
  if (is_between_or_beside(around[4], point, way)) return false;
  int last = around[4];
  for (int k = 0; k < 4; ++k) {
    if (around[k] == around[4] || around[k] == last) continue;
    last = around[k];
    if (is_between_or_beside(last, point, way)) return false;
  }
  return true;
}

vec3 point_of(ivec2 texel, int its_layer) {
  return texel_of(points, texel + ivec2(0, its_layer * textureSize(normals, 0).y)).xyz;
}

bool sees(vec3 point) {
  vec3 way = point - origin;
  vec3 local = to_local * way;
  return local.z > hair && is_lit(point, way, local);
}

/// What each of the cluster's elements would bring if nothing were between. The hemicube stands at one
/// point of the cluster and stands for all of it; where the point's horizon cuts the cluster, for
/// what is above. Of an element that is partly covered (w below 1) the corners say little: a disc at
/// one of its open points stands for it.
vec3 from_elements(vec3 point, vec3 normal, int its_layer) {
  if (dot(origin - point, normal) <= 0.0) return vec3(0.0);
  ivec2 size = textureSize(normals, 0);
  vec3 sum = vec3(0.0);
  float flux = 0.0;
  float flux_above = 0.0;
  for (int i = first; i < first + count; ++i) {
    ivec2 there = place_of(i, size);
    vec4 leaving = texel_of(unshot, there);
    vec4 source = texel_of(normals, there);
    float factor;
    float above;
    if (leaving.w < 1.0) {
      vec3 way = point_of(there, its_layer) - point;
      factor = point_to_disc(way, normal, source.xyz, source.w);
      above = dot(way, normal) > 0.0 ? 1.0 : 0.0;
    } else {
      vec3 a = texel_of(corners, there).xyz - point;
      vec3 b = texel_of(corners, there + ivec2(0, size.y)).xyz - point;
      vec3 c = texel_of(corners, there + ivec2(0, 2 * size.y)).xyz - point;
      factor = point_to_triangle(a, b, c, normal);
      above = share_above(dot(a, normal), dot(b, normal), dot(c, normal));
    }
    sum += leaving.xyz * factor;
    float its_flux = source.w * (leaving.x + leaving.y + leaving.z);
    flux += its_flux;
    flux_above += its_flux * above;
  }
  return flux_above > 0.0 ? sum * (flux / flux_above) : vec3(0.0);
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  irradiance = vec4(0.0);
  vec4 normal = texel_of(normals, here);
  if (normal.w == 0.0) return;
  vec3 point = point_of(here, layer);
  vec3 to_centre = centre - point;
  if (dot(to_centre, to_centre) >= near_square) {
    vec3 source_normal = vec3(to_local[0].z, to_local[1].z, to_local[2].z);
    float factor = point_to_disc(origin - point, normal.xyz, source_normal, area);
    if (factor > 0.0 && sees(point)) irradiance = vec4(radiosity * factor, 0.0);
    return;
  }
  // Nearby a form factor changes over the receiving element: a few of its points, well apart.
  const int kNearPoints = 4;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < kNearPoints; ++k) {
    int its_layer = (layer + k * (layers / kNearPoints)) % layers;
    point = point_of(here, its_layer);
    if (sees(point)) sum += from_elements(point, normal.xyz, its_layer);
  }
  irradiance = vec4(sum / float(kNearPoints), 0.0);
}
