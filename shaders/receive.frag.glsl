// SPDX-License-Identifier: MIT
// What is gathered, scaled so that all of a shot's flux that is not lost arrives; to be added to what
// was received before. TALLY: the flux that is lost instead.
#include "shaders/texel.glsl"

uniform sampler2D arrived;  // 1x1: flux, by the sum over the elements
uniform sampler2D lost;     // 1x1: delta form factors, of all pixels and of those that lose light
uniform vec3 flux;          // shot
#ifndef TALLY
uniform sampler2D gathered;
#endif

layout(location = 0) out vec4 received;

void main() {
  vec3 sum = texel_of(arrived, ivec2(0)).xyz;
  vec2 deltas = texel_of(lost, ivec2(0)).xy;
  vec3 arriving = flux * (1.0 - deltas.y / deltas.x);
#ifdef TALLY
  received = vec4(sum.x > 0.0 ? flux.x - arriving.x : flux.x,
                  sum.y > 0.0 ? flux.y - arriving.y : flux.y,
                  sum.z > 0.0 ? flux.z - arriving.z : flux.z, 0.0);
#else
  vec3 scale = vec3(sum.x > 0.0 ? arriving.x / sum.x : 0.0, sum.y > 0.0 ? arriving.y / sum.y : 0.0,
                    sum.z > 0.0 ? arriving.z / sum.z : 0.0);
  received = vec4(texel_of(gathered, ivec2(gl_FragCoord.xy)).xyz * scale, 0.0);
#endif
}
