// SPDX-License-Identifier: MIT
#include "lantern/scene/surface.h"

#include "lantern/core/hash.h"
#include "lantern/scene/texture.h"

#include <algorithm>
#include <bit>

namespace lantern {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const uvec3& v, Vec2 uv) {
  return values[v.x] * (1.0f - uv.x - uv.y) + values[v.y] * uv.x + values[v.z] * uv.y;
}

Vec2 texcoord_at(const World& world, std::uint32_t triangle, Vec2 uv) {
  return world.texcoords.empty() ? Vec2(0.0f)
                                 : interpolate(world.texcoords, world.triangles[triangle], uv);
}

const Material& material_of(const Scene& scene, const World& world, std::uint32_t triangle) {
  return scene.materials[index(world.materials[triangle])];
}

}  // namespace

SurfacePoint surface_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv) {
  const uvec3 v = world.triangles[triangle];
  const Material& material = material_of(scene, world, triangle);
  SurfacePoint point;
  point.position = interpolate(world.positions, v, uv);
  point.geometric_normal = glm::normalize(world.area_vector(triangle));
  point.shading_normal = point.geometric_normal;
  if (!world.normals.empty()) {
    const Vec3 n = interpolate(world.normals, v, uv);
    const float length = glm::length(n);
    // Shorter than this the vertices disagree so much that their mean says nothing.
    constexpr float kShortest = 1e-3f;
    if (length > kShortest) {
      point.shading_normal = n / length;
      if (glm::dot(point.shading_normal, point.geometric_normal) < 0.0f) {
        point.shading_normal = -point.shading_normal;
      }
    }
  }
  point.reflectance = material.reflectance;
  if (material.reflectance_texture) {
    point.reflectance *= Rgb(sample(scene.textures[index(*material.reflectance_texture)],
                                    texcoord_at(world, triangle, uv)));
  }
  if (material.vertex_colours && !world.colours.empty()) {
    point.reflectance *= Rgb(interpolate(world.colours, v, uv));
  }
  point.reflectance = glm::clamp(point.reflectance, 0.0f, 1.0f);
  return point;
}

Rgb emission_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv,
                bool from_front) {
  const Material& material = material_of(scene, world, triangle);
  if (is_black(material.emission) || !(from_front || material.double_sided)) return Rgb(0.0f);
  if (!material.emission_texture) return material.emission;
  return material.emission * Rgb(sample(scene.textures[index(*material.emission_texture)],
                                        texcoord_at(world, triangle, uv)));
}

std::optional<float> even_coverage(const Material& material) {
  const bool is_even = material.blend && !material.alpha_cutoff && !material.reflectance_texture &&
                       !material.vertex_colours;
  if (!is_even) return std::nullopt;
  return std::clamp(material.opacity, 0.0f, 1.0f);
}

float coverage_at(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv) {
  const Material& material = material_of(scene, world, triangle);
  if (!has_holes(material)) return 1.0f;
  float opacity = material.opacity;
  if (material.reflectance_texture) {
    opacity *= sample(scene.textures[index(*material.reflectance_texture)],
                      texcoord_at(world, triangle, uv))
                   .a;
  }
  if (material.vertex_colours && !world.colours.empty()) {
    opacity *= interpolate(world.colours, world.triangles[triangle], uv).a;
  }
  if (material.alpha_cutoff) return opacity < *material.alpha_cutoff ? 0.0f : 1.0f;
  return std::clamp(opacity, 0.0f, 1.0f);
}

bool is_hole(const Scene& scene, const World& world, std::uint32_t triangle, Vec2 uv,
             const Vec3& origin, const Vec3& direction) {
  const float coverage = coverage_at(scene, world, triangle, uv);
  if (coverage <= 0.0f || coverage >= 1.0f) return coverage <= 0.0f;
  std::uint64_t key = triangle;
  for (const Vec3& v : {origin, direction}) {
    for (int axis = 0; axis < 3; ++axis) key = hash(key, std::bit_cast<std::uint32_t>(v[axis]));
  }
  return to_unit_float(key) >= coverage;
}

float mean_reflectivity(const Scene& scene, const World& world) {
  // A texture's mean is taken once per material, not once per triangle.
  std::vector<Rgb> of_texture(scene.materials.size(), Rgb(1.0f));
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (const auto& id = scene.materials[i].reflectance_texture) {
      of_texture[i] = Rgb(mean(scene.textures[index(*id)]));
    }
  }
  double area_sum = 0.0, weighted = 0.0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& material = material_of(scene, world, t);
    Rgb reflectance = material.reflectance * of_texture[index(world.materials[t])];
    if (material.vertex_colours && !world.colours.empty()) {
      reflectance *= Rgb(interpolate(world.colours, world.triangles[t], Vec2(1.0f / 3.0f)));
    }
    const double area = world.area(t);
    area_sum += area;
    weighted += area * mean_component(glm::clamp(reflectance, 0.0f, 1.0f));
  }
  return area_sum > 0.0 ? static_cast<float>(weighted / area_sum) : 0.0f;
}

}  // namespace lantern
