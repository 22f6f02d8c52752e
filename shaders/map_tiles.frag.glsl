// SPDX-License-Identifier: MIT
// What encloses the points of each tile of TILE x TILE pixels, and their normals.
#include "shaders/map_receivers.glsl"

layout(location = 0) out uvec4 o_sphere;  // bits of floats: centre, radius
// A unit vector; how far others are from it, how far points are off its plane through the centre, as
// bits of floats; their patch, or 0.
layout(location = 1) out uvec4 o_normals;

void main() {
  ivec2 first = TILE * ivec2(gl_FragCoord.xy), last = textureSize(u_points, 0) - 1;
  const float kFar = 1e30;
  vec3 low = vec3(kFar), high = vec3(-kFar), normals = vec3(0.0);
  uint common_patch = 0u, there = 0u;  // bits of pixels that see something
  bool is_common = true;
  int i = 0;
  do {
    ivec2 at = min(first + ivec2(i % TILE, i / TILE), last);
    Receiver p = receiver_at(at);
    if (p.first == 0u) continue;
    there |= 1u << uint(i);
    if (common_patch == 0u) common_patch = p.its_patch;
    is_common = is_common && p.its_patch != 0u && p.its_patch == common_patch;
    low = min(low, p.position);
    high = max(high, p.position);
    normals += p.geometric;
  } while (++i < TILE * TILE);
  o_sphere = uvec4(floatBitsToUint(vec4(0.0, 0.0, 0.0, -1.0)));
  o_normals = uvec4(0u);
  if (there == 0u) return;
  vec3 centre = 0.5 * (low + high);
  uint packed_normal = pack_unit(normals);
  vec3 normal = unpack_unit(packed_normal);
  float radius = 0.0, thickness = 0.0, spread = 0.0;
  i = 0;
  do {
    if ((there >> uint(i) & 1u) == 0u) continue;
    ivec2 at = min(first + ivec2(i % TILE, i / TILE), last);
    Receiver p = receiver_at(at);
    vec3 off = p.position - centre;
    radius = max(radius, length(off));
    thickness = max(thickness, abs(dot(normal, off)));
    spread = max(spread, length(p.geometric - normal));
  } while (++i < TILE * TILE);
  o_sphere = floatBitsToUint(vec4(centre, radius));
  o_normals = uvec4(packed_normal, floatBitsToUint(spread), floatBitsToUint(thickness),
                    is_common ? common_patch : 0u);
}
