// SPDX-License-Identifier: MIT
// What one light gives to a point, were nothing between: the geometry by which its intensity (or,
// from infinity, its irradiance) becomes irradiance. d is the way from the point to the light, d2
// its square; cosines times the length of d are at_point and at_light. [Keller 1997, equation 4]

/// Lambertian light: cos cos / d², cut at the bound. Intensity is flux / π.
LANTERN_SHARED float surface_light_share(float at_point, float at_light, float d2, float bound) {
  float term = (at_point * at_light) / (d2 * d2);
  return term < bound ? term : bound;
}

/// Point and spot lights; the cone's cosines are those of the inner and outer half angle, (-2, -3)
/// of a point light that is no spot. Intensity is that on the axis.
LANTERN_SHARED float punctual_light_share(float at_point, float at_light, float d2, float distance,
                                          float cos_inner, float cos_outer) {
  float ramp = (at_light / distance - cos_outer) / (cos_inner - cos_outer);
  ramp = ramp < 0.0f ? 0.0f : ramp;
  ramp = ramp > 1.0f ? 1.0f : ramp;
  return ramp * ramp * at_point / (d2 * distance);
}
