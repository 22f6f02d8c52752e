// SPDX-License-Identifier: MIT
#include "lantern/radiosity/external_light.h"

#include "lantern/radiosity/element_points.h"
#include "lantern/radiosity/random.h"
#include "lantern/radiosity/sky_sampler.h"
#include "lantern/scene/sky.h"

#include <algorithm>
#include <optional>

namespace lantern {
namespace {

/// Rays to the sky from each of an element's points, in strata.
constexpr int kSkyStrata = 6;
constexpr int kSkyRays = kSkyStrata * kSkyStrata;

/// Share of the axis' intensity: 1 within the inner angle, 0 outside the outer one, in between the
/// square of a ramp over the cosine, as the specification of KHR_lights_punctual has it.
float spot_share(const PunctualLight& light, const Vec3& from_light) {
  constexpr float kNarrowest = 1e-4f;
  const float inner = std::cos(light.inner_angle), outer = std::cos(light.outer_angle);
  const float cosine = glm::dot(glm::normalize(from_light), glm::normalize(light.direction));
  const float ramp = std::clamp((cosine - outer) / std::max(inner - outer, kNarrowest), 0.0f, 1.0f);
  return ramp * ramp;
}

/// From one light at a point, shadows apart: what arrives, and the way to the light.
struct Arrival {
  Rgb irradiance;
  Vec3 way;
  float far;  // in lengths of `way`
};

Arrival arrival(const PunctualLight& light, const Vec3& position, const Vec3& normal) {
  if (light.kind == PunctualKind::kDirectional) {
    const Vec3 way = -glm::normalize(light.direction);
    return {light.intensity * std::max(glm::dot(way, normal), 0.0f), way, kInfinity};
  }
  const Vec3 way = light.position - position;
  const float square = glm::dot(way, way);
  if (!(square > 0.0f)) return {Rgb(0.0f), way, 1.0f};
  const float share = light.kind == PunctualKind::kSpot ? spot_share(light, -way) : 1.0f;
  const float cosine = std::max(glm::dot(way, normal), 0.0f) / std::sqrt(square);
  return {light.intensity * (share * cosine / square), way, 1.0f};
}

class Gatherer {
 public:
  Gatherer(const Scene& scene, const Tracer& tracer) : scene_(scene), tracer_(tracer) {
    if (scene.sky && scene.sky->texture) sampler_.emplace(scene);
  }

  Rgb at(const Vec3& position, const Vec3& normal, std::uint64_t key) const {
    Rgb sum(0.0f);
    for (const PunctualLight& light : scene_.lights) {
      const Arrival from = arrival(light, position, normal);
      if (is_black(from.irradiance)) continue;
      if (!tracer_.occluded({.origin = position, .direction = from.way, .far = from.far})) {
        sum += from.irradiance;
      }
    }
    if (scene_.sky) sum += from_sky(position, normal, key);
    return sum;
  }

 private:
  Rgb from_sky(const Vec3& position, const Vec3& normal, std::uint64_t key) const {
    Random random(key);
    Rgb sum(0.0f);
    for (int i = 0; i < kSkyRays; ++i) {
      const Vec2 cell(static_cast<float>(i % kSkyStrata), static_cast<float>(i / kSkyStrata));
      const float x = random.unit(), y = random.unit();
      const Vec2 u = (cell + Vec2(x, y)) / static_cast<float>(kSkyStrata);
      Vec3 towards;
      Rgb irradiance;
      if (sampler_) {
        const SkySampler::Draw draw = sampler_->draw(u);
        towards = draw.towards;
        irradiance = draw.radiance_over_pdf * std::max(glm::dot(towards, normal), 0.0f);
      } else {
        towards = Frame(normal).to_world(cosine_direction(u));
        irradiance = kPi * sky_radiance(scene_, towards);
      }
      if (is_black(irradiance)) continue;
      if (!tracer_.occluded({.origin = position, .direction = towards})) sum += irradiance;
    }
    return sum / static_cast<float>(kSkyRays);
  }

  const Scene& scene_;
  const Tracer& tracer_;
  std::optional<SkySampler> sampler_;
};

}  // namespace

std::vector<glm::dvec3> external_irradiance(const Scene& scene, const World& world,
                                            const Tracer& tracer, const Patches& patches,
                                            const StopFlag& stop) {
  std::vector<glm::dvec3> result(patches.elements(), glm::dvec3(0.0));
  if (scene.lights.empty() && !scene.sky) return result;
  constexpr std::size_t kGrain = 16;
  const ElementPoints points(world, tracer, patches);
  const Gatherer gatherer(scene, tracer);
  parallel_for(patches.elements(), kGrain, [&](std::size_t e) {
    if (patches.exposed[e] == 0.0 || stop.load()) return;
    const Vec3 normal(patches.element_normal(e));
    for (std::size_t k = 0; k < ElementPoints::kPoints; ++k) {
      result[e] += glm::dvec3(gatherer.at(points.at(e, k), normal, hash(e, k)));
    }
    result[e] /= static_cast<double>(ElementPoints::kPoints);
  });
  return result;
}

}  // namespace lantern
