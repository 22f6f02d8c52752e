// SPDX-License-Identifier: MIT
#include "lantern/path/light_choice.h"

#include "lantern/core/hash.h"
#include "lantern/sampling/warp.h"
#include "lantern/scene/sky.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"
#include "lantern/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lantern {
namespace {

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

constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

}  // namespace

LightChoice::LightChoice(const Scene& scene, const World& world)
    : scene_(scene), world_(world), scale_(world.coordinate_scale()) {
  std::vector<LightBound> bounds;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& material = scene.materials[index(world.materials[t])];
    if (is_black(material.emission)) continue;
    has_light_ = true;
    add_triangle(t, true, bounds);
    if (material.double_sided) add_triangle(t, false, bounds);
  }
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) add_punctual(i, bounds);
  if (scene.sky) add_sky();
  tree_ = LightTree(bounds);
}

void LightChoice::add_triangle(std::uint32_t triangle, bool front,
                               std::vector<LightBound>& bounds) {
  const auto strength = static_cast<float>(mean_radiance(scene_, world_, triangle, front) *
                                           static_cast<double>(world_.area(triangle)));
  if (!(strength > 0.0f) || !std::isfinite(strength)) return;
  LightBound& bound = bounds.emplace_back();
  for (int corner = 0; corner < 3; ++corner) {
    bound.box.add(world_.positions[world_.triangles[triangle][corner]]);
  }
  bound.axis = glm::normalize(world_.area_vector(triangle)) * (front ? 1.0f : -1.0f);
  bound.strength = strength;
  if (leaf_of_.empty()) leaf_of_.resize(world_.size(), {kNoLeaf, kNoLeaf});
  leaf_of_[triangle][front ? 0 : 1] = static_cast<std::uint32_t>(near_.size());
  near_.push_back({front ? Kind::kFront : Kind::kBack, triangle});
}

void LightChoice::add_punctual(std::uint32_t light, std::vector<LightBound>& bounds) {
  const PunctualLight& punctual = scene_.lights[light];
  const float strength = mean_component(punctual.intensity);
  if (!(strength > 0.0f) || !std::isfinite(strength)) return;
  has_light_ = true;
  if (punctual.kind == PunctualKind::kDirectional) {
    distant_.push_back({Kind::kPunctual, light});
    return;
  }
  near_.push_back({Kind::kPunctual, light});
  LightBound& bound = bounds.emplace_back();
  bound.box.add(punctual.position);
  bound.strength = strength;
  bound.spread = kPi;
  if (punctual.kind == PunctualKind::kSpot) {
    bound.axis = glm::normalize(punctual.direction);
    bound.spread = punctual.outer_angle;
  }
}

void LightChoice::add_sky() {
  if (is_black(scene_.sky->radiance)) return;
  if (!scene_.sky->texture) {
    has_light_ = true;
    return;
  }
  const Texture& texture = scene_.textures[index(*scene_.sky->texture)];
  const std::vector<double> weights = sky_weights(texture);
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  if (!(sum > 0.0)) return;
  has_light_ = true;
  sky_choice_ = Distribution2D(weights, texture.width, texture.height);
  // A surface sees half of the sphere, at a mean cosine of 1/2.
  sky_irradiance_ = static_cast<float>(sum) * mean_component(scene_.sky->radiance) * 0.25f;
  distant_.push_back({Kind::kSky, 0});
}

/// About what a distant light sends to the point; above zero, as the tree's is.
float LightChoice::distant_irradiance(std::size_t i, const LitPoint& point) const {
  if (distant_[i].kind == Kind::kSky) return sky_irradiance_;
  const PunctualLight& sun = scene_.lights[distant_[i].index];
  constexpr float kLeastCosine = 0.02f;
  return mean_component(sun.intensity) *
         std::max(kLeastCosine, -glm::dot(point.normal, glm::normalize(sun.direction)));
}

float LightChoice::all_distant_irradiance(const LitPoint& point) const {
  float sum = 0.0f;
  for (std::size_t i = 0; i < distant_.size(); ++i) sum += distant_irradiance(i, point);
  return sum;
}

LightSample LightChoice::sample(const LitPoint& point, Vec2 u) const {
  float of_distant = 0.0f;  // the probability that one of them is chosen
  if (!distant_.empty()) {
    const float distant = all_distant_irradiance(point);
    of_distant =
        tree_.empty() ? 1.0f : distant / (distant + tree_.importance(point.position, point.normal));
    if (u.x < of_distant) {
      float at = u.x / of_distant * distant;
      for (std::size_t i = 0; i < distant_.size(); ++i) {
        const float irradiance = distant_irradiance(i, point);
        if (at >= irradiance && i + 1 < distant_.size()) {
          at -= irradiance;
          continue;
        }
        u.x = std::min(at / irradiance, kBelowOne);
        return sample_from(distant_[i], of_distant * irradiance / distant, point, u);
      }
    }
    u.x = std::min((u.x - of_distant) / (1.0f - of_distant), kBelowOne);
  }
  if (tree_.empty()) return {};
  const LightTree::Choice chosen = tree_.choose(point.position, point.normal, u.x);
  u.x = chosen.rest;
  return sample_from(near_[chosen.light], (1.0f - of_distant) * chosen.probability, point, u);
}

LightSample LightChoice::sample_from(const Source& source, float probability, const LitPoint& point,
                                     Vec2 u) const {
  switch (source.kind) {
    case Kind::kPunctual:
      return sample_punctual(scene_.lights[source.index], probability, point.position);
    case Kind::kSky:
      return sample_sky(probability, u);
    case Kind::kFront:
    case Kind::kBack:
      break;
  }
  return sample_triangle(source, probability, point.position, u);
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
  sample.to_light = sample.direction = from_lat_long(chosen.position);
  sample.far = kInfinity;
  sample.pdf_solid_angle = probability * chosen.pdf / lat_long_solid_angle(chosen.position);
  // Looked up by the direction, as for rays that find it by themselves.
  sample.radiance = sky_radiance(scene_, sample.direction) / sample.pdf_solid_angle;
  return sample;
}

float LightChoice::pdf_of_hit(const LitPoint& point, std::uint32_t triangle, const Vec3& direction,
                              float distance) const {
  if (leaf_of_.empty()) return 0.0f;
  const Vec3 area_vector = world_.area_vector(triangle);
  const float projected = glm::dot(area_vector, direction);
  const std::uint32_t leaf = leaf_of_[triangle][projected < 0.0f ? 0 : 1];
  if (leaf == kNoLeaf || projected == 0.0f) return 0.0f;
  float probability = tree_.probability(leaf, point.position, point.normal);
  if (!distant_.empty()) {
    const float near = tree_.importance(point.position, point.normal);
    probability *= near / (near + all_distant_irradiance(point));
  }
  return 2.0f * probability * distance * distance / std::abs(projected);
}

float LightChoice::pdf_of_sky(const LitPoint& point, const Vec3& direction) const {
  if (sky_irradiance_ == 0.0f) return 0.0f;
  const float near = tree_.empty() ? 0.0f : tree_.importance(point.position, point.normal);
  const float probability = sky_irradiance_ / (near + all_distant_irradiance(point));
  const Vec2 at = to_lat_long(direction);
  return probability * sky_choice_.pdf(at) / lat_long_solid_angle(at);
}

}  // namespace lantern
