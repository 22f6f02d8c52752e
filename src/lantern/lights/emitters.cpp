// SPDX-License-Identifier: MIT
#include "lantern/lights/emitters.h"

#include "lantern/sampling/warp.h"
#include "lantern/scene/sky.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lantern {
namespace {

/// The sky's luminance by the cells of its texture, weighted by their solid angle. A cell takes the
/// mean of its corner look-ups, so that none which the filter reaches has no chance.
Distribution2D make_sky_choice(const Texture& texture, double& mean_luminance_times_sphere) {
  std::vector<double> weights(static_cast<std::size_t>(texture.width) *
                              static_cast<std::size_t>(texture.height));
  double sum = 0.0;
  for (int y = 0; y < texture.height; ++y) {
    const double top = std::numbers::pi * y / texture.height;
    const double bottom = std::numbers::pi * (y + 1.0) / texture.height;
    const double solid_angle =
        2.0 * std::numbers::pi / texture.width * (std::cos(top) - std::cos(bottom));
    for (int x = 0; x < texture.width; ++x) {
      double value = 0.0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int tx = (x + dx + texture.width) % texture.width;
          const int ty = std::clamp(y + dy, 0, texture.height - 1);
          const Rgb radiance(texel(texture, tx, ty));
          value += std::max(0.0, static_cast<double>(mean_component(radiance))) *
                   (dx == 0 ? 2.0 : 1.0) * (dy == 0 ? 2.0 : 1.0) / 16.0;
        }
      }
      const double weight = std::isfinite(value) ? value * solid_angle : 0.0;
      weights[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) +
              static_cast<std::size_t>(x)] = weight;
      sum += weight;
    }
  }
  mean_luminance_times_sphere = sum;
  return sum > 0.0 ? Distribution2D(weights, texture.width, texture.height) : Distribution2D();
}

/// Points along the side of the grid that a triangle's flux is summed over: one for each texel that
/// its longest edge crosses, so that no lamp drawn into the texture falls through.
int flux_grid(const Texture& texture, const World& world, std::uint32_t triangle) {
  constexpr float kFewest = 16.0f, kMost = 256.0f;
  if (world.texcoords.empty()) return 1;
  const uvec3 v = world.triangles[triangle];
  const Vec2 size(texture.width, texture.height);
  float longest = 0.0f;
  for (int corner = 0; corner < 3; ++corner) {
    const Vec2 edge = world.texcoords[v[(corner + 1) % 3]] - world.texcoords[v[corner]];
    longest = std::max(longest, glm::length(edge * size));
  }
  if (!std::isfinite(longest)) return static_cast<int>(kMost);
  return static_cast<int>(std::clamp(std::ceil(longest), kFewest, kMost));
}

}  // namespace

Rgb triangle_flux(const Scene& scene, const World& world, std::uint32_t triangle, bool front) {
  const Material& material = scene.materials[index(world.materials[triangle])];
  glm::dvec3 mean_radiance(0.0);
  if (!material.emission_texture) {
    mean_radiance = emission_at(scene, world, triangle, Vec2(1.0f / 3.0f), front);
  } else {
    const int grid = flux_grid(scene.textures[index(*material.emission_texture)], world, triangle);
    const float cell = 1.0f / static_cast<float>(grid);
    for (int y = 0; y < grid; ++y) {
      for (int x = 0; x < grid; ++x) {
        const Vec2 u((static_cast<float>(x) + 0.5f) * cell, (static_cast<float>(y) + 0.5f) * cell);
        mean_radiance += emission_at(scene, world, triangle, square_to_triangle(u), front);
      }
    }
    mean_radiance /= static_cast<double>(grid) * grid;
  }
  return Rgb(mean_radiance) * (kPi * world.area(triangle));
}

Emitters::Emitters(const Scene& scene, const World& world)
    : scene_(scene),
      world_(world),
      centre_(world.bounds.empty() ? Vec3(0.0f) : world.bounds.centre()),
      radius_(world.bounds.radius()) {
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& material = scene.materials[index(world.materials[t])];
    if (is_black(material.emission)) continue;
    add({Kind::kFront, t}, triangle_flux(scene, world, t, true));
    if (material.double_sided) add({Kind::kBack, t}, triangle_flux(scene, world, t, false));
  }
  const float disc = kPi * radius_ * radius_;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    switch (light.kind) {
      case PunctualKind::kPoint:
        add({Kind::kPunctual, i}, light.intensity * (4.0f * kPi));
        break;
      case PunctualKind::kSpot:
        add({Kind::kPunctual, i},
            light.intensity *
                spot_solid_angle({std::cos(light.inner_angle), std::cos(light.outer_angle)}));
        break;
      case PunctualKind::kDirectional:
        add({Kind::kPunctual, i}, light.intensity * disc);
        break;
    }
  }
  if (scene.sky) {
    Rgb irradiance = scene.sky->radiance * (4.0f * kPi);
    if (scene.sky->texture) {
      double integral = 0.0;
      const Texture& texture = scene.textures[index(*scene.sky->texture)];
      sky_choice_ = make_sky_choice(texture, integral);
      irradiance = scene.sky->radiance * static_cast<float>(integral);
    }
    add({Kind::kSky, 0}, irradiance * disc);
  }
  if (!sources_.empty()) choice_ = Distribution(weights_);
}

void Emitters::add(Source source, const Rgb& flux) {
  const float weight = mean_component(flux);
  if (!(weight > 0.0f) || !std::isfinite(weight)) return;
  sources_.push_back(source);
  weights_.push_back(weight);
  flux_ += flux;
}

PathStart Emitters::start(Vec2 place, Vec2 way) const {
  const Distribution::Choice chosen = choice_.choose(place.x);
  const Source& source = sources_[chosen.index];
  place.x = chosen.rest;
  switch (source.kind) {
    case Kind::kPunctual:
      return start_at_punctual(scene_.lights[source.index], chosen.probability, way);
    case Kind::kSky:
      return start_at_sky(chosen.probability, place, way);
    case Kind::kFront:
    case Kind::kBack:
      break;
  }
  return start_on_triangle(source, chosen.probability, place, way);
}

PathStart Emitters::start_on_triangle(const Source& source, float probability, Vec2 place,
                                      Vec2 way) const {
  const bool front = source.kind == Kind::kFront;
  const Vec2 uv = square_to_triangle(place);
  const SurfacePoint point = surface_at(scene_, world_, source.index, uv);
  PathStart start;
  start.position = point.position;
  start.normal = front ? point.geometric_normal : -point.geometric_normal;
  start.light_flux = emission_at(scene_, world_, source.index, uv, front) *
                     (coverage_at(scene_, world_, source.index, uv) * kPi *
                      world_.area(source.index) / probability);
  start.ray_flux = start.light_flux;
  start.origin = start.position;
  start.direction = Frame(start.normal).to_world(square_to_cosine_hemisphere(way));
  return start;
}

PathStart Emitters::start_at_punctual(const PunctualLight& light, float probability,
                                      Vec2 way) const {
  const Vec3 axis = glm::normalize(light.direction);
  if (light.kind == PunctualKind::kDirectional) {
    return start_from_infinity(axis, light.intensity / probability, way);
  }
  PathStart start;
  start.position = light.position;
  start.origin = light.position;
  start.normal = axis;
  if (light.kind == PunctualKind::kPoint) {
    start.kind = LightKind::kPoint;
    start.light_flux = light.intensity * (4.0f * kPi / probability);
    start.ray_flux = start.light_flux;
    start.direction = square_to_sphere(way);
  } else {
    start.kind = LightKind::kSpot;
    start.cone = {std::cos(light.inner_angle), std::cos(light.outer_angle)};
    start.light_flux = light.intensity * (spot_solid_angle(start.cone) / probability);
    const Vec3 local = square_to_cone(way, start.cone.y);
    const float cone_solid_angle = 2.0f * kPi * (1.0f - start.cone.y);
    start.ray_flux =
        light.intensity * (spot_falloff(local.z, start.cone) * cone_solid_angle / probability);
    start.direction = Frame(axis).to_world(local);
  }
  return start;
}

PathStart Emitters::start_at_sky(float probability, Vec2 place, Vec2 way) const {
  if (!scene_.sky->texture) {
    const Vec3 towards_sky = square_to_sphere(place);
    return start_from_infinity(-towards_sky, scene_.sky->radiance * (4.0f * kPi / probability),
                               way);
  }
  const Distribution2D::Point chosen = sky_choice_.sample(place);
  const Vec3 towards_sky = from_lat_long(chosen.position);
  const float pdf_solid_angle = chosen.pdf / lat_long_solid_angle(chosen.position);
  return start_from_infinity(
      -towards_sky, sky_radiance(scene_, towards_sky) / (pdf_solid_angle * probability), way);
}

PathStart Emitters::start_from_infinity(const Vec3& direction, const Rgb& irradiance,
                                        Vec2 way) const {
  PathStart start;
  start.kind = LightKind::kDirectional;
  start.normal = direction;
  start.light_flux = irradiance;
  start.ray_flux = irradiance * (kPi * radius_ * radius_);
  const Frame frame(direction);
  const Vec2 disc = square_to_disc(way) * radius_;
  start.origin =
      centre_ - direction * (2.0f * radius_) + frame.tangent * disc.x + frame.bitangent * disc.y;
  start.direction = direction;
  return start;
}

}  // namespace lantern
