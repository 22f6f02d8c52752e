// SPDX-License-Identifier: MIT
#include "lantern/radiosity/direct_light.h"

#include "lantern/core/parallel.h"
#include "lantern/radiosity/random.h"

#include <algorithm>
#include <numbers>

namespace lantern {
namespace {

constexpr int kRays = kPacket;

struct Source {
  std::uint32_t element;
  glm::dvec3 centre, normal;
  double area;
  double radiosity;  // sum of the channels
};

std::vector<Source> sources_of(const Patches& patches) {
  std::vector<Source> sources;
  for (std::uint32_t e = 0; e < patches.elements(); ++e) {
    const glm::dvec3 emission = patches.emission[e];
    if (emission == glm::dvec3(0.0)) continue;
    sources.push_back({e, patches.centre[patches.patch[e]], patches.element_normal(e),
                       patches.exposed_area(e), emission.r + emission.g + emission.b});
  }
  return sources;
}

Vec3 random_point(const Patches& patches, std::uint32_t element, Random& random, float scale) {
  const std::uint32_t patch = patches.patch[element];
  const Vec2 w = random.in_triangle();
  const Vec3 a(patches.mesh.corner(patch, 0)), b(patches.mesh.corner(patch, 1)),
      c(patches.mesh.corner(patch, 2));
  return off_surface(a + w.x * (b - a) + w.y * (c - a), Vec3(patches.element_normal(element)),
                     scale);
}

}  // namespace

std::vector<DirectLight> direct_light(const World& world, const Tracer& tracer,
                                      const Patches& patches) {
  const std::vector<Source> sources = sources_of(patches);
  const float scale = world.coordinate_scale();
  std::vector<DirectLight> result(patches.elements());
  constexpr std::size_t kGrain = 64;
  parallel_for(sources.empty() ? 0 : result.size(), kGrain, [&](std::size_t e) {
    const glm::dvec3 centre = patches.centre[patches.patch[e]], normal = patches.element_normal(e);
    DirectLight& light = result[e];
    std::vector<double> below(sources.size());  // what the sources up to each bring
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const Source& source = sources[s];
      const glm::dvec3 way = source.centre - centre;
      const double square = glm::dot(way, way);
      const double here = glm::dot(way, normal), there = -glm::dot(way, source.normal);
      if (here > 0.0 && there > 0.0) {
        const double factor = source.area * here * there / (std::numbers::pi * square * square);
        light.form_factor += factor;
        light.irradiance += factor * source.radiosity;
      }
      below[s] = light.irradiance;
    }
    if (!(light.irradiance > 0.0)) return;

    RayPacket rays;
    LaneMask active;
    Random random(hash(e));
    for (int i = 0; i < kRays; ++i) {
      // One in each sixteenth of what all sources bring.
      const double target = (i + static_cast<double>(random.unit())) / kRays * light.irradiance;
      const auto found = std::upper_bound(below.begin(), below.end() - 1, target);
      const Source& source = sources[static_cast<std::size_t>(found - below.begin())];
      const Vec3 from = random_point(patches, static_cast<std::uint32_t>(e), random, scale);
      rays.set(i, from, random_point(patches, source.element, random, scale) - from, 1.0f);
      active.lane[i] = -1;
    }
    tracer.occluded(active, rays);
    const auto passed = std::count_if(rays.far, rays.far + kRays, [](float f) { return f > 0.0f; });
    // No ray passes from what is covered; it is no part of the element.
    const double exposed = std::max(patches.exposed[e], 1.0 / kRays);
    light.seen = std::min(1.0, static_cast<double>(passed) / (kRays * exposed));
    light.form_factor *= light.seen;
    light.irradiance *= light.seen;
  });
  return result;
}

}  // namespace lantern
