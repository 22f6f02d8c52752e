// SPDX-License-Identifier: MIT
#include "lantern/scene/world.h"

#include "lantern/core/error.h"

#include <cassert>
#include <utility>

namespace lantern {
namespace {

Vec3 normalized_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0.0f && std::isfinite(length) ? v / length : Vec3(0.0f);
}

/// Appends `source`, or that many copies of `missing`, once any mesh of the scene has such values.
template <typename T>
void append(std::vector<T>& target, const std::vector<T>& source, std::size_t count, T missing) {
  if (source.empty()) {
    target.resize(target.size() + count, missing);
  } else {
    target.insert(target.end(), source.begin(), source.end());
  }
}

}  // namespace

World make_world(const Scene& scene) {
  World world;
  std::size_t vertices = 0, triangles = 0;
  bool has_normals = false, has_texcoords = false, has_colours = false;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[index(instance.mesh)];
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
    has_normals |= !mesh.normals.empty();
    has_texcoords |= !mesh.texcoords.empty();
    has_colours |= !mesh.colours.empty();
  }
  if (vertices > std::numeric_limits<std::uint32_t>::max() ||
      triangles > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format(
        "the scene's instances have {} vertices and {} triangles; the limit of each is 2^32",
        vertices, triangles));
  }
  world.positions.reserve(vertices);
  world.triangles.reserve(triangles);
  world.materials.reserve(triangles);
  if (has_normals) world.normals.reserve(vertices);
  if (has_texcoords) world.texcoords.reserve(vertices);
  if (has_colours) world.colours.reserve(vertices);

  bool finite = true;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[index(instance.mesh)];
    const std::size_t count = mesh.positions.size();
    const auto first = static_cast<std::uint32_t>(world.positions.size());
    const bool identity = instance.transform == Mat4(1.0f);
    const Mat3 linear(instance.transform);
    // The cofactor matrix carries normals also where the transform has no inverse.
    const Mat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                        glm::cross(linear[0], linear[1]));
    const bool mirrored = glm::determinant(linear) < 0.0f;

    for (const Vec3& p : mesh.positions) {
      const Vec3 q = identity ? p : Vec3(instance.transform * Vec4(p, 1.0f));
      world.positions.push_back(q);
      finite &= is_finite(q);
    }
    if (has_normals) {
      append(world.normals, mesh.normals, count, Vec3(0.0f));
      for (std::size_t i = first; i < world.normals.size(); ++i) {
        const Vec3 n = identity ? world.normals[i] : cofactor * world.normals[i];
        world.normals[i] = normalized_or_zero(mirrored ? -n : n);
      }
    }
    if (has_texcoords) append(world.texcoords, mesh.texcoords, count, Vec2(0.0f));
    if (has_colours) append(world.colours, mesh.colours, count, Vec4(1.0f));

    const MaterialId material = instance.material.value_or(mesh.material);
    for (uvec3 t : mesh.triangles) {
      if (mirrored) std::swap(t.y, t.z);
      world.triangles.push_back(t + first);
      world.materials.push_back(material);
      // A transform can flatten what had an area, and nothing can be done with what has no normal.
      if (!has_area(world.area_vector(static_cast<std::uint32_t>(world.triangles.size() - 1)))) {
        world.triangles.pop_back();
        world.materials.pop_back();
        continue;
      }
      for (int corner = 0; corner < 3; ++corner) {
        world.bounds.add(world.positions[world.triangles.back()[corner]]);
      }
    }
  }
  if (!finite) throw Error("an instance's transform takes the scene out of the range of numbers");
  return world;
}

}  // namespace lantern
