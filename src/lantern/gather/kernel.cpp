// SPDX-License-Identifier: MIT
#include "lantern/gather/kernel.h"

#include <bit>
#include <cstring>

// The loops are written once in sixteen-wide vectors and compiled for each instruction set; the
// loader picks. Sanitizers cannot follow that choice, nor does it exist off x86.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LANTERN_FOR_EACH_ISA \
  __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default")))
#else
#define LANTERN_FOR_EACH_ISA
#endif

namespace lantern {
namespace {

using Float16 [[gnu::vector_size(kPacket * sizeof(float))]] = float;
using Int16 [[gnu::vector_size(kPacket * sizeof(std::int32_t))]] = std::int32_t;

#define LANTERN_INLINE [[gnu::always_inline]] inline

LANTERN_INLINE void load(const float* from, Float16& to) { std::memcpy(&to, from, sizeof(to)); }
LANTERN_INLINE void store(const Float16& from, float* to) { std::memcpy(to, &from, sizeof(from)); }

/// Everything of the loop that does not change from light to light.
struct Lanes {
  Float16 x, y, z, sx, sy, sz, gx, gy, gz;
  Int16 active;
};

struct Sum {
  Float16 r, g, b;
};

/// The share of one light: adds `intensity` times `geometry` where the ray is free.
struct Share {
  Float16 geometry;
  Int16 wanted;  // all ones where the light can be seen at all
};

LANTERN_INLINE std::uint32_t bits_of(const Int16& mask) {
  std::uint32_t bits = 0;
  for (int i = 0; i < kPacket; ++i) bits |= (mask[i] != 0 ? 1u : 0u) << i;
  return bits;
}

LANTERN_INLINE void mask_of(std::uint32_t bits, Int16& mask) {
  constexpr Int16 kLaneBit = {1 << 0, 1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                              1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  const Int16 all = Int16{} + static_cast<std::int32_t>(bits);
  mask = (all & kLaneBit) != 0;
}

std::uint32_t trace_singly(const Tracer& tracer, const LaneMask& active, const RayPacket& rays) {
  std::uint32_t blocked = 0;
  for (int i = 0; i < kPacket; ++i) {
    if (active.lane[i] == 0) continue;
    Ray ray;
    ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
    ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    ray.near = rays.near[i];
    ray.far = rays.far[i];
    blocked |= (tracer.occluded(ray) ? 1u : 0u) << i;
  }
  return blocked;
}

/// Traces the wanted rays to (dx, dy, dz) times `far` and adds what arrives.
LANTERN_INLINE std::uint64_t add_visible(const Tracer& tracer, ShadowRays how, RayPacket& rays,
                                         const Float16& dx, const Float16& dy, const Float16& dz,
                                         float far, const Share& share, const float* intensity,
                                         Sum& sum) {
  const std::uint32_t wanted = bits_of(share.wanted);
  if (wanted == 0) return 0;
  alignas(64) LaneMask active;
  std::memcpy(active.lane, &share.wanted, sizeof(active.lane));
  store(dx, rays.direction_x);
  store(dy, rays.direction_y);
  store(dz, rays.direction_z);
  store(Float16{} + far, rays.far);
  const std::uint32_t blocked = how == ShadowRays::kPackets ? tracer.occluded(active, rays)
                                                            : trace_singly(tracer, active, rays);
  Int16 lit;
  mask_of(wanted & ~blocked, lit);
  const Float16 geometry = lit ? share.geometry : Float16{};
  sum.r += geometry * intensity[0];
  sum.g += geometry * intensity[1];
  sum.b += geometry * intensity[2];
  return static_cast<std::uint64_t>(std::popcount(wanted));
}

}  // namespace

GatherLights::GatherLights(const VirtualLights& lights, float coordinate_scale) {
  const auto put = [](float* target, const Vec3& v) {
    target[0] = v.x;
    target[1] = v.y;
    target[2] = v.z;
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Rgb flux = lights.flux[i];
    if (is_black(flux)) continue;
    const Vec3 normal = lights.normal[i];
    switch (lights.kind[i]) {
      case LightKind::kSurface: {
        Surface& light = surface.emplace_back();
        put(light.position, off_surface(lights.position[i], normal, coordinate_scale));
        put(light.normal, normal);
        put(light.flux, flux * kInvPi);
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
}

LANTERN_FOR_EACH_ISA
std::uint64_t gather_irradiance(const GatherLights& lights, const ShadingPacket& points,
                                const Tracer& tracer, float bound, ShadowRays how,
                                IrradiancePacket& irradiance) {
  Lanes p;
  load(points.x, p.x);
  load(points.y, p.y);
  load(points.z, p.z);
  load(points.shading_x, p.sx);
  load(points.shading_y, p.sy);
  load(points.shading_z, p.sz);
  load(points.geometric_x, p.gx);
  load(points.geometric_y, p.gy);
  load(points.geometric_z, p.gz);
  std::memcpy(&p.active, points.active.lane, sizeof(p.active));

  RayPacket rays;
  store(p.x, rays.origin_x);
  store(p.y, rays.origin_y);
  store(p.z, rays.origin_z);
  store(Float16{}, rays.near);
  store(Float16{}, rays.time);
  for (int i = 0; i < kPacket; ++i) {
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<std::uint32_t>(i);
    rays.flags[i] = 0;
  }

  std::uint64_t traced = 0;
  Sum sum{};
  const Float16 cut = Float16{} + bound;
  for (const GatherLights::Surface& light : lights.surface) {
    const Float16 dx = light.position[0] - p.x;
    const Float16 dy = light.position[1] - p.y;
    const Float16 dz = light.position[2] - p.z;
    const Float16 d2 = dx * dx + dy * dy + dz * dz;
    // Cosines times distance: their product over d² d² is the geometry term, without a root.
    const Float16 at_point = p.sx * dx + p.sy * dy + p.sz * dz;
    const Float16 beside = p.gx * dx + p.gy * dy + p.gz * dz;
    const Float16 at_light = -(light.normal[0] * dx + light.normal[1] * dy + light.normal[2] * dz);
    const Float16 term = (at_point * at_light) / (d2 * d2);
    Share share;
    share.geometry = term < cut ? term : cut;
    share.wanted = p.active & (at_point > 0.0f) & (beside > 0.0f) & (at_light > 0.0f);
    traced += add_visible(tracer, how, rays, dx, dy, dz, 1.0f, share, light.flux, sum);
  }
  for (const GatherLights::Point& light : lights.point) {
    const Float16 dx = light.position[0] - p.x;
    const Float16 dy = light.position[1] - p.y;
    const Float16 dz = light.position[2] - p.z;
    const Float16 d2 = dx * dx + dy * dy + dz * dz;
    Float16 distance;
    for (int i = 0; i < kPacket; ++i) distance[i] = __builtin_sqrtf(d2[i]);
    const Float16 at_point = p.sx * dx + p.sy * dy + p.sz * dz;
    const Float16 beside = p.gx * dx + p.gy * dy + p.gz * dz;
    const Float16 cos_at_light =
        -(light.axis[0] * dx + light.axis[1] * dy + light.axis[2] * dz) / distance;
    Float16 ramp = (cos_at_light - light.cone[1]) / (light.cone[0] - light.cone[1]);
    ramp = ramp < 0.0f ? Float16{} : ramp;
    ramp = ramp > 1.0f ? Float16{} + 1.0f : ramp;
    Share share;
    share.geometry = ramp * ramp * at_point / (d2 * distance);
    share.wanted = p.active & (at_point > 0.0f) & (beside > 0.0f) & (ramp > 0.0f);
    traced += add_visible(tracer, how, rays, dx, dy, dz, 1.0f, share, light.intensity, sum);
  }
  for (const GatherLights::Directional& light : lights.directional) {
    const Float16 dx = Float16{} - light.direction[0];
    const Float16 dy = Float16{} - light.direction[1];
    const Float16 dz = Float16{} - light.direction[2];
    const Float16 at_point = p.sx * dx + p.sy * dy + p.sz * dz;
    const Float16 beside = p.gx * dx + p.gy * dy + p.gz * dz;
    Share share;
    share.geometry = at_point;
    share.wanted = p.active & (at_point > 0.0f) & (beside > 0.0f);
    traced += add_visible(tracer, how, rays, dx, dy, dz, kInfinity, share, light.irradiance, sum);
  }
  store(sum.r, irradiance.r);
  store(sum.g, irradiance.g);
  store(sum.b, irradiance.b);
  return traced;
}

}  // namespace lantern
