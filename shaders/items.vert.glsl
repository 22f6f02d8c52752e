// SPDX-License-Identifier: MIT
// A triangle of the scene onto one face of a hemicube's item buffer.
#include "shaders/texel.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uint surface;  // the triangle's number times 2, and 1 if its back is alive

uniform vec3 origin;
uniform mat3 to_local;  // the hemicube's z is the shooter's normal
uniform int face;       // 0 the top, then +x, -x, +y, -y
uniform float near;
uniform vec2 shift;  // on the cube, of what pixels see from their centres
uniform sampler2D planes;  // of the triangles: dot(xyz, x) + w = 0

flat out uint item;  // 0 is nothing

void main() {
  int triangle = int(surface >> 1);
  int width = textureSize(planes, 0).x;
  vec4 plane = texel_of(planes, ivec2(triangle % width, triangle / width));
  bool front = dot(plane.xyz, origin) + plane.w > 0.0;
  bool dead = !front && (surface & 1u) == 0u;
  item = uint(triangle) + 1u + (dead ? 0x80000000u : 0u);
  vec3 p = to_local * (position - origin);
  if (face == 0) {
    gl_Position = vec4(p.xy - shift * p.z, p.z - 2.0 * near, p.z);
  } else {
    float away = face < 3 ? p.x : p.y;
    float w = (face & 1) == 1 ? away : -away;
    float u = face < 3 ? p.y : p.x;
    gl_Position = vec4(u - shift.x * w, 2.0 * (p.z - shift.y * w) - w, w - 2.0 * near, w);
  }
}
