// SPDX-License-Identifier: MIT
// Up to LIGHTS (32) lights of one kind (KIND: 0 surface, 1 point or spot, 2 directional) and what
// they give.
#include "shaders/light_share.glsl"

struct Light {
  vec4 place;    // position (directional: the way the light travels); bound, or cosine of inner
  vec4 axis;     // normal or axis; cosine of outer
  vec4 strength; // intensity, or irradiance from infinity
};
#ifndef LIGHTS
#define LIGHTS 32
#endif
layout(std140) uniform Lights { Light u_lights[LIGHTS]; };

struct Point {
  vec3 position, shading, geometric;
};

/// As long as the light is far; of a directional light a unit vector.
vec3 way_to(Light light, Point p) {
#if KIND == 2
  return -light.place.xyz;
#else
  return light.place.xyz - p.position;
#endif
}

vec3 irradiance_from(Light light, Point p) {
  vec3 d = way_to(light, p);
  float at_point = dot(p.shading, d);
  if (at_point <= 0.0 || dot(p.geometric, d) <= 0.0) return vec3(0.0);
#if KIND == 2
  return at_point * light.strength.rgb;
#else
  float at_light = -dot(light.axis.xyz, d);
  float d2 = dot(d, d);
#if KIND == 0
  if (at_light <= 0.0) return vec3(0.0);
  return surface_light_share(at_point, at_light, d2, light.place.w) * light.strength.rgb;
#else
  return punctual_light_share(at_point, at_light, d2, sqrt(d2), light.place.w, light.axis.w) *
         light.strength.rgb;
#endif
#endif
}
