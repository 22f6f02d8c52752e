// SPDX-License-Identifier: MIT
#include "lantern/path/light_choice.h"

#include "lantern/sampling/warp.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"
#include "lantern/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lantern {
namespace {

/// Azimuth from -z over +x and polar angle from +y, both as shares of the picture: the lat-long map
/// of scene.h.
Vec2 lat_long(const Vec3& direction) {
  const float turns = std::atan2(direction.x, -direction.z) / (2.0f * kPi);
  return {turns - std::floor(turns), std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / kPi};
}

Vec3 direction_at(Vec2 lat_long) {
  const float azimuth = lat_long.x * 2.0f * kPi, polar = lat_long.y * kPi;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar),
          -std::sin(polar) * std::cos(azimuth)};
}

/// Solid angle of a unit of area of the map.
float map_to_sphere(Vec2 lat_long) {
  constexpr float kPole = 1e-6f;
  return 2.0f * kPi * kPi * std::max(kPole, std::sin(kPi * lat_long.y));
}

/// The picture's mean channel over each cell, times its solid angle. Look-ups blend neighbours:
/// what can be seen anywhere in a cell has a part in its weight.
std::vector<double> sky_weights(const Texture& texture) {
  std::vector<double> weights;
  for (int y = 0; y < texture.height; ++y) {
    const double solid_angle = 2.0 * std::numbers::pi / texture.width *
                               (std::cos(std::numbers::pi * y / texture.height) -
                                std::cos(std::numbers::pi * (y + 1) / texture.height));
    for (int x = 0; x < texture.width; ++x) {
      constexpr int kFilter[3] = {1, 2, 1};
      double sum = 0.0;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          const Vec4 value = texel(texture, (x + i - 1 + texture.width) % texture.width,
                                   std::clamp(y + j - 1, 0, texture.height - 1));
          sum += kFilter[i] * kFilter[j] / 16.0 *
                 static_cast<double>(mean_component(glm::max(Rgb(value), Rgb(0.0f))));
        }
      }
      weights.push_back(std::isfinite(sum) ? sum * solid_angle : 0.0);
    }
  }
  return weights;
}

/// Mean radiance of one side of a triangle. A texture is looked up on a grid as fine as the texels
/// along the longest edge, within limits: what falls through is found by rays alone.
double mean_radiance(const Scene& scene, const World& world, std::uint32_t triangle, bool front) {
  const Material& material = scene.materials[index(world.materials[triangle])];
  int grid = 1;
  if (material.emission_texture && !world.texcoords.empty()) {
    const Texture& texture = scene.textures[index(*material.emission_texture)];
    const uvec3 v = world.triangles[triangle];
    float texels = 0.0f;
    for (int i = 0; i < 3; ++i) {
      const Vec2 edge = world.texcoords[v[(i + 1) % 3]] - world.texcoords[v[i]];
      texels = std::max(texels, glm::length(edge * Vec2(texture.width, texture.height)));
    }
    constexpr float kFewest = 8.0f, kMost = 256.0f;
    grid = static_cast<int>(std::isfinite(texels) ? std::clamp(texels, kFewest, kMost) : kMost);
  }
  double sum = 0.0;
  for (int i = 0; i < grid * grid; ++i) {
    const Vec2 u = (Vec2(i % grid, i / grid) + 0.5f) / static_cast<float>(grid);
    sum += static_cast<double>(
        mean_component(emission_at(scene, world, triangle, square_to_triangle(u), front)));
  }
  return sum / (static_cast<double>(grid) * grid);
}

/// Share of the intensity on a spot's axis at an angle of cosine `cos_axis`: a squared ramp between
/// the cosines of its cones (glTF's KHR_lights_punctual).
float spot_share(const PunctualLight& light, float cos_axis) {
  constexpr float kSharpest = 1e-4f;
  const float inner = std::cos(light.inner_angle), outer = std::cos(light.outer_angle);
  const float ramp =
      std::clamp((cos_axis - outer) / std::max(kSharpest, inner - outer), 0.0f, 1.0f);
  return ramp * ramp;
}

/// The integral of spot_share() over the sphere.
double spot_solid_angle(const PunctualLight& light) {
  const double inner = std::cos(static_cast<double>(light.inner_angle));
  const double outer = std::cos(static_cast<double>(light.outer_angle));
  return 2.0 * std::numbers::pi * (1.0 - inner + (inner - outer) / 3.0);
}

}  // namespace

LightChoice::LightChoice(const Scene& scene, const World& world)
    : scene_(scene), world_(world), scale_(world.coordinate_scale()) {
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& material = scene.materials[index(world.materials[t])];
    if (is_black(material.emission)) continue;
    has_light_ = true;
    const double to_flux = std::numbers::pi * static_cast<double>(world.area(t));
    add({Kind::kFront, t}, to_flux * mean_radiance(scene, world, t, true));
    if (material.double_sided) {
      add({Kind::kBack, t}, to_flux * mean_radiance(scene, world, t, false));
    }
  }
  const double radius = static_cast<double>(world.bounds.radius());
  const double disc = std::numbers::pi * radius * radius;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    const double to_flux = light.kind == PunctualKind::kPoint  ? 4.0 * std::numbers::pi
                           : light.kind == PunctualKind::kSpot ? spot_solid_angle(light)
                                                               : disc;
    add({Kind::kPunctual, i}, to_flux * static_cast<double>(mean_component(light.intensity)));
  }
  if (scene.sky && !is_black(scene.sky->radiance)) {
    if (scene.sky->texture) {
      const Texture& texture = scene.textures[index(*scene.sky->texture)];
      const std::vector<double> weights = sky_weights(texture);
      double sum = 0.0;
      for (const double weight : weights) sum += weight;
      if (sum > 0.0) {
        sky_choice_ = Distribution2D(weights, texture.width, texture.height);
        add({Kind::kSky, 0}, sum * disc * static_cast<double>(mean_component(scene.sky->radiance)));
      }
    } else {
      has_light_ = true;
    }
  }
  has_light_ |= !sources_.empty();
  if (sources_.empty()) return;
  choice_ = Distribution(weights_);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    if (source.kind == Kind::kSky) sky_probability_ = choice_.probability(i);
    if (source.kind != Kind::kFront && source.kind != Kind::kBack) continue;
    if (pdf_area_.empty()) pdf_area_.resize(world.size());
    pdf_area_[source.index][source.kind == Kind::kFront ? 0 : 1] =
        choice_.probability(i) / world.area(source.index);
  }
}

void LightChoice::add(Source source, double flux) {
  if (!(flux > 0.0) || !std::isfinite(flux)) return;
  sources_.push_back(source);
  weights_.push_back(flux);
}

LightSample LightChoice::sample(const Vec3& point, Vec2 u) const {
  if (sources_.empty()) return {};
  const Distribution::Choice chosen = choice_.choose(u.x);
  u.x = chosen.rest;
  const Source& source = sources_[chosen.index];
  switch (source.kind) {
    case Kind::kPunctual:
      return sample_punctual(scene_.lights[source.index], chosen.probability, point);
    case Kind::kSky:
      return sample_sky(chosen.probability, u);
    case Kind::kFront:
    case Kind::kBack:
      break;
  }
  return sample_triangle(source, chosen.probability, point, u);
}

LightSample LightChoice::sample_triangle(const Source& source, float probability, const Vec3& point,
                                         Vec2 u) const {
  const uvec3 v = world_.triangles[source.index];
  const Vec3 a = world_.positions[v.x];
  const Vec3 ab = world_.positions[v.y] - a, ac = world_.positions[v.z] - a;
  const Vec3 area_vector = glm::cross(ab, ac);
  const float twice_area = glm::length(area_vector);
  const bool front = source.kind == Kind::kFront;
  const Vec3 normal = area_vector * ((front ? 1.0f : -1.0f) / twice_area);
  const Vec2 uv = square_to_triangle(u);

  LightSample sample;
  sample.to_light = off_surface(a + ab * uv.x + ac * uv.y, normal, scale_) - point;
  const float distance2 = glm::dot(sample.to_light, sample.to_light);
  const float at_light = -glm::dot(normal, sample.to_light);  // cosine times distance
  if (!(at_light > 0.0f)) return {};
  const float distance = std::sqrt(distance2);
  sample.direction = sample.to_light / distance;
  sample.pdf_solid_angle = 2.0f * probability / twice_area * distance2 * distance / at_light;
  sample.radiance = emission_at(scene_, world_, source.index, uv, front) *
                    (coverage_at(scene_, world_, source.index, uv) / sample.pdf_solid_angle);
  return sample;
}

LightSample LightChoice::sample_punctual(const PunctualLight& light, float probability,
                                         const Vec3& point) const {
  LightSample sample;
  const Vec3 axis = glm::normalize(light.direction);
  if (light.kind == PunctualKind::kDirectional) {
    sample.to_light = sample.direction = -axis;
    sample.far = kInfinity;
    sample.radiance = light.intensity / probability;
    return sample;
  }
  sample.to_light = light.position - point;
  const float distance2 = glm::dot(sample.to_light, sample.to_light);
  if (!(distance2 > 0.0f)) return {};
  sample.direction = sample.to_light / std::sqrt(distance2);
  sample.radiance = light.intensity / (distance2 * probability);
  if (light.kind == PunctualKind::kSpot) {
    sample.radiance *= spot_share(light, -glm::dot(axis, sample.direction));
  }
  return sample;
}

LightSample LightChoice::sample_sky(float probability, Vec2 u) const {
  const Distribution2D::Point chosen = sky_choice_.sample(u);
  LightSample sample;
  sample.to_light = sample.direction = direction_at(chosen.position);
  sample.far = kInfinity;
  sample.pdf_solid_angle = probability * chosen.pdf / map_to_sphere(chosen.position);
  // Looked up by the direction, as for rays that find it by themselves.
  sample.radiance = sky(sample.direction).radiance / sample.pdf_solid_angle;
  return sample;
}

float LightChoice::pdf_of_hit(std::uint32_t triangle, const Vec3& direction, float distance) const {
  if (pdf_area_.empty()) return 0.0f;
  const Vec3 area_vector = world_.area_vector(triangle);
  const float projected = glm::dot(area_vector, direction);
  const float pdf_area = pdf_area_[triangle][projected < 0.0f ? 0 : 1];
  if (pdf_area == 0.0f || projected == 0.0f) return 0.0f;
  return pdf_area * distance * distance * glm::length(area_vector) / std::abs(projected);
}

LightChoice::Sky LightChoice::sky(const Vec3& direction) const {
  if (!scene_.sky) return {};
  if (!scene_.sky->texture) return {scene_.sky->radiance, 0.0f};
  const Vec2 at = lat_long(direction);
  const Texture& texture = scene_.textures[index(*scene_.sky->texture)];
  Sky sky;
  sky.radiance = scene_.sky->radiance * glm::max(Rgb(lantern::sample(texture, at)), Rgb(0.0f));
  if (sky_probability_ > 0.0f) {
    sky.pdf_solid_angle = sky_probability_ * sky_choice_.pdf(at) / map_to_sphere(at);
  }
  return sky;
}

}  // namespace lantern
