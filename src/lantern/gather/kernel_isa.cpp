// SPDX-License-Identifier: MIT
// The loop of kernel.h in sixteen-wide vectors, compiled once for each instruction set: LANTERN_ISA
// names the copy. No function of a shared header may be emitted here, or the linker could
// keep this copy of it for machines that cannot run it: hence plain pointers and no containers.
#include "lantern/gather/kernel_isa.h"

#include <cstring>

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
  Int16 rays;
};

/// What one light would add, were nothing between.
struct Share {
  Float16 geometry;
  Int16 wanted;  // all ones where the light can be seen at all
};

LANTERN_INLINE bool any(const LaneMask& mask) {
  std::uint64_t pairs[kPacket / 2];
  std::memcpy(pairs, mask.lane, sizeof(pairs));
  std::uint64_t all = 0;
  for (const std::uint64_t pair : pairs) all |= pair;
  return all != 0;
}

void trace_singly(const Tracer& tracer, const LaneMask& active, RayPacket& rays) {
  for (int i = 0; i < kPacket; ++i) {
    if (active.lane[i] == 0) continue;
    Ray ray;
    ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
    ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    ray.near = rays.near[i];
    ray.far = rays.far[i];
    if (tracer.occluded(ray)) rays.far[i] = -kInfinity;
  }
}

/// Traces the wanted rays to (dx, dy, dz) times `far` and adds what arrives.
LANTERN_INLINE void add_visible(const Tracer& tracer, ShadowRays how, RayPacket& rays,
                                const Float16& dx, const Float16& dy, const Float16& dz, float far,
                                const Share& share, const float* intensity, Sum& sum) {
  LaneMask active;
  std::memcpy(active.lane, &share.wanted, sizeof(active.lane));
  if (!any(active)) return;
  sum.rays -= share.wanted;
  store(dx, rays.direction_x);
  store(dy, rays.direction_y);
  store(dz, rays.direction_z);
  store(Float16{} + far, rays.far);
  if (how == ShadowRays::kPackets) {
    tracer.occluded(active, rays);
  } else {
    trace_singly(tracer, active, rays);
  }
  Float16 reached;
  load(rays.far, reached);
  const Int16 lit = share.wanted & (reached >= 0.0f);
  const Float16 geometry = lit ? share.geometry : Float16{};
  sum.r += geometry * intensity[0];
  sum.g += geometry * intensity[1];
  sum.b += geometry * intensity[2];
}

}  // namespace

std::uint64_t LANTERN_ISA(const LightSpans& lights, const ShadingPacket& points,
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

  Sum sum{};
  for (std::size_t l = 0; l < lights.surface_count; ++l) {
    const GatherLights::Surface& light = lights.surface[l];
    const Float16 dx = light.position[0] - p.x;
    const Float16 dy = light.position[1] - p.y;
    const Float16 dz = light.position[2] - p.z;
    const Float16 d2 = dx * dx + dy * dy + dz * dz;
    // Cosines times distance: their product over d² d² is the geometry term, without a root.
    const Float16 at_point = p.sx * dx + p.sy * dy + p.sz * dz;
    const Float16 beside = p.gx * dx + p.gy * dy + p.gz * dz;
    const Float16 at_light = -(light.normal[0] * dx + light.normal[1] * dy + light.normal[2] * dz);
    const Float16 term = (at_point * at_light) / (d2 * d2);
    const Float16 cut = Float16{} + (light.bound > bound ? light.bound : bound);
    Share share;
    share.geometry = term < cut ? term : cut;
    share.wanted = p.active & (at_point > 0.0f) & (beside > 0.0f) & (at_light > 0.0f);
    add_visible(tracer, how, rays, dx, dy, dz, 1.0f, share, light.flux, sum);
  }
  for (std::size_t l = 0; l < lights.point_count; ++l) {
    const GatherLights::Point& light = lights.point[l];
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
    add_visible(tracer, how, rays, dx, dy, dz, 1.0f, share, light.intensity, sum);
  }
  for (std::size_t l = 0; l < lights.directional_count; ++l) {
    const GatherLights::Directional& light = lights.directional[l];
    const Float16 dx = Float16{} - light.direction[0];
    const Float16 dy = Float16{} - light.direction[1];
    const Float16 dz = Float16{} - light.direction[2];
    const Float16 at_point = p.sx * dx + p.sy * dy + p.sz * dz;
    const Float16 beside = p.gx * dx + p.gy * dy + p.gz * dz;
    Share share;
    share.geometry = at_point;
    share.wanted = p.active & (at_point > 0.0f) & (beside > 0.0f);
    add_visible(tracer, how, rays, dx, dy, dz, kInfinity, share, light.irradiance, sum);
  }
  store(sum.r, irradiance.r);
  store(sum.g, irradiance.g);
  store(sum.b, irradiance.b);
  std::uint64_t traced = 0;
  for (int i = 0; i < kPacket; ++i) traced += static_cast<std::uint64_t>(sum.rays[i]);
  return traced;
}

}  // namespace lantern
