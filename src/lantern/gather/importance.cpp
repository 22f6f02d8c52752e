// SPDX-License-Identifier: MIT
#include "lantern/gather/importance.h"

#include "lantern/core/hash.h"
#include "lantern/sampling/kronecker.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/eye.h"

#include <algorithm>
#include <cstdint>

namespace lantern {
namespace {

/// One point for so many pixels: a pool of 16 then costs a thirty-second part of the gather.
constexpr int kPixelsPerPoint = 512;
constexpr int kFewestPackets = 1;
constexpr int kMostPackets = 16;
/// The lights that tell how bright the points are.
constexpr std::size_t kLightsForBrightness = 1024;
/// On the geometry term, in units of 1/(bounding radius)²: next to a light it says nothing about
/// the picture as a whole.
constexpr float kBound = 5.0f;
/// Of the mean brightness: darker points count no more than these.
constexpr float kDarkest = 0.01f;
constexpr std::size_t kGrain = 16;

/// Powers of the plastic number: spread over the picture for every count. [Roberts 2018]
constexpr glm::dvec2 kPictureSequence(0.75487766624669276005, 0.56984029099805326591);

/// What the camera sees, in packets, spread over the picture.
std::vector<ShadingPacket> points_seen(const GatherInput& in, const GatherOptions& options) {
  const Eye eye(in.camera, options.width, options.height);
  const float scale = in.world.coordinate_scale();
  const auto packets = static_cast<std::size_t>(std::clamp(
      static_cast<int>(std::int64_t{options.width} * options.height / (kPixelsPerPoint * kPacket)),
      kFewestPackets, kMostPackets));
  std::vector<ShadingPacket> result;
  const std::uint64_t key = hash(options.seed, options.pass);
  const Vec2 shift(to_unit_float(key), to_unit_float(hash(key)));
  for (std::size_t k = 0; k < packets; ++k) {
    ShadingPacket packet{};
    bool any = false;
    for (std::size_t i = 0; i < kPacket; ++i) {
      const Vec2 place = kronecker(k * kPacket + i, kPictureSequence, shift);
      Ray ray;
      ray.origin = eye.origin();
      ray.direction = eye.direction(place.x * static_cast<float>(options.width),
                                    place.y * static_cast<float>(options.height));
      const Hit hit = in.tracer.closest(ray);
      if (!hit) continue;
      const SurfacePoint surface = surface_at(in.scene, in.world, hit.triangle, hit.uv);
      if (is_black(surface.reflectance)) continue;
      const bool front = glm::dot(surface.geometric_normal, ray.direction) < 0.0f;
      const float side = front ? 1.0f : -1.0f;
      packet.set(i, off_surface(surface.position, surface.geometric_normal * side, scale),
                 surface.shading_normal * side, surface.geometric_normal * side);
      any = true;
    }
    if (any) result.push_back(packet);
  }
  return result;
}

/// How bright each point is, by a part of the pool; dark ones lifted.
std::vector<Rgb> brightness(const GatherInput& in, const VirtualLights& pool, float bound,
                            const std::vector<ShadingPacket>& points) {
  const std::size_t stride = 1 + pool.size() / kLightsForBrightness;
  GatherLights some;
  for (std::size_t i = 0; i < pool.size(); i += stride) {
    some.add(pool, i, in.world.coordinate_scale());
  }
  std::vector<Rgb> result(points.size() * kPacket);
  parallel_for(points.size(), 1, [&](std::size_t k) {
    IrradiancePacket e;
    gather_irradiance(some, points[k], in.tracer, bound, ShadowRays::kPackets, e);
    for (std::size_t i = 0; i < kPacket; ++i) result[k * kPacket + i] = Rgb(e.r[i], e.g[i], e.b[i]);
  });
  float mean = 0.0f;
  for (const Rgb& e : result) mean += mean_component(e) / static_cast<float>(result.size());
  for (Rgb& e : result) e += kDarkest * mean;
  return result;
}

}  // namespace

std::vector<double> importance(const GatherInput& input, const VirtualLights& pool,
                               const GatherOptions& options) {
  std::vector<double> result(pool.size(), 0.0);
  const std::vector<ShadingPacket> points = points_seen(input, options);
  const float radius = input.world.bounds.radius();
  const float bound = kBound / (radius * radius);
  const std::vector<Rgb> bright = brightness(input, pool, bound, points);
  parallel_for(pool.size(), kGrain, [&](std::size_t light) {
    GatherLights alone;
    alone.add(pool, light, input.world.coordinate_scale());
    if (alone.size() == 0) return;
    glm::dvec3 parts(0.0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      IrradiancePacket e;
      gather_irradiance(alone, points[k], input.tracer, bound, ShadowRays::kPackets, e);
      for (std::size_t i = 0; i < kPacket; ++i) {
        const glm::dvec3 given(e.r[i], e.g[i], e.b[i]), all(bright[k * kPacket + i]);
        for (int c = 0; c < 3; ++c) parts[c] += all[c] > 0.0 ? given[c] / all[c] : 0.0;
      }
    }
    result[light] = std::max({parts.r, parts.g, parts.b});
  });
  return result;
}

}  // namespace lantern
