// SPDX-License-Identifier: MIT
#include "lantern/gather/kernel.h"

#include "lantern/gather/kernel_isa.h"

namespace lantern {
namespace {

/// The widest copy of the loop that this machine runs.
GatherKernel* widest_kernel() {
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return gather_irradiance_avx512;
  }
  if (__builtin_cpu_supports("avx2")) return gather_irradiance_avx2;
#endif
  return gather_irradiance_baseline;
}

}  // namespace

GatherLights::GatherLights(const VirtualLights& lights, float coordinate_scale,
                           std::span<const float> bounds) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    add(lights, i, coordinate_scale, bounds.empty() ? 0.0f : bounds[i]);
  }
}

void GatherLights::add(const VirtualLights& lights, std::size_t i, float coordinate_scale,
                       float own_bound) {
  const auto put = [](float* target, const Vec3& v) {
    target[0] = v.x;
    target[1] = v.y;
    target[2] = v.z;
  };
  const Rgb flux = lights.flux[i];
  if (is_black(flux)) return;
  const Vec3 normal = lights.normal[i];
  switch (lights.kind[i]) {
    case LightKind::kSurface: {
      Surface& light = surface.emplace_back();
      put(light.position, off_surface(lights.position[i], normal, coordinate_scale));
      put(light.normal, normal);
      put(light.flux, flux * kInvPi);
      light.bound = own_bound;
      break;
    }
    case LightKind::kPoint:
    case LightKind::kSpot: {
      const bool spot = lights.kind[i] == LightKind::kSpot;
      Point& light = point.emplace_back();
      put(light.position, lights.position[i]);
      put(light.axis, normal);
      put(light.intensity, flux / (spot ? spot_solid_angle(lights.cone[i]) : 4.0f * kPi));
      light.cone[0] = spot ? lights.cone[i].x : -2.0f;
      light.cone[1] = spot ? lights.cone[i].y : -3.0f;
      break;
    }
    case LightKind::kDirectional: {
      Directional& light = directional.emplace_back();
      put(light.direction, normal);
      put(light.irradiance, flux);
      break;
    }
  }
}

std::uint64_t gather_irradiance(const GatherLights& lights, const ShadingPacket& points,
                                const Tracer& tracer, float bound, ShadowRays rays,
                                IrradiancePacket& irradiance) {
  static GatherKernel* const kernel = widest_kernel();
  const LightSpans spans{lights.surface.data(), lights.point.data(), lights.directional.data(),
                         lights.surface.size(), lights.point.size(), lights.directional.size()};
  return kernel(spans, points, tracer, bound, rays, irradiance);
}

}  // namespace lantern
