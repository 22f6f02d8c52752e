// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace lantern::ogre {
namespace {

constexpr std::array<std::string_view, 6> kOperations{
    "point_list", "line_list", "line_strip", "triangle_list", "triangle_strip", "triangle_fan"};

std::vector<uvec3> triangles_of(std::span<const std::uint32_t> v, Operation operation) {
  std::vector<uvec3> triangles;
  if (operation == Operation::kTriangleList) {
    triangles.reserve(v.size() / 3);
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
      triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
    }
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    uvec3 t(v[i], v[i + 1], v[i + 2]);
    if (operation == Operation::kTriangleFan) {
      t.x = v[0];
    } else if (i % 2 == 1) {
      std::swap(t.x, t.y);
    }
    // Strips are stitched with triangles of no area.
    if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
  }
  return triangles;
}

template <typename T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::uint32_t>& which) {
  if (all.empty()) return {};
  std::vector<T> result;
  result.reserve(which.size());
  for (std::uint32_t i : which) result.push_back(all[i]);
  return result;
}

/// Keeps the vertices that the triangles use, in their order, and renumbers the triangles. Takes
/// time by the triangles alone, as many small submeshes may share many vertices.
Geometry compact(const Geometry& geometry, std::vector<uvec3>& triangles) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const uvec3& t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto place = [&](std::uint32_t i) {
    return static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin());
  };
  for (uvec3& t : triangles) t = uvec3(place(t.x), place(t.y), place(t.z));
  return {chosen(geometry.positions, used), chosen(geometry.normals, used),
          chosen(geometry.texcoords, used), chosen(geometry.colours, used)};
}

}  // namespace

std::optional<Operation> operation_named(std::string_view name) {
  const auto found = std::find(kOperations.begin(), kOperations.end(), name);
  if (found == kOperations.end()) return std::nullopt;
  return static_cast<Operation>(found - kOperations.begin() + 1);
}

bool is_operation(std::uint16_t value) { return value >= 1 && value <= kOperations.size(); }

bool has_triangles(Operation operation) { return operation >= Operation::kTriangleList; }

std::vector<std::optional<MeshId>> add_meshes(const MeshFile& file, Materials& materials) {
  Scene& scene = materials.scene();
  std::vector<std::optional<MeshId>> ids;
  for (const Submesh& submesh : file.submeshes) {
    if (!has_triangles(submesh.operation)) {
      const auto name = kOperations[static_cast<std::size_t>(submesh.operation) - 1];
      ++materials.report().unknown[fmt::format("mesh: {}", name)];
      ids.push_back(std::nullopt);
      continue;
    }
    std::vector<std::uint32_t> in_order;
    if (submesh.indices.empty() && submesh.own) {
      in_order.resize(submesh.own->positions.size());
      std::iota(in_order.begin(), in_order.end(), 0u);
    }
    std::vector<uvec3> triangles =
        triangles_of(submesh.indices.empty() ? in_order : submesh.indices, submesh.operation);
    Geometry geometry;
    if (submesh.own) {
      geometry = *submesh.own;
    } else if (file.shared) {
      geometry = compact(*file.shared, triangles);
    }

    Mesh mesh;
    mesh.name = submesh.name.empty() ? fmt::format("submesh {}", ids.size()) : submesh.name;
    mesh.positions = std::move(geometry.positions);
    mesh.normals = std::move(geometry.normals);
    mesh.texcoords = std::move(geometry.texcoords);
    mesh.colours = std::move(geometry.colours);
    mesh.triangles = std::move(triangles);
    mesh.material = materials.use(submesh.material, submesh.textures);
    ids.push_back(to_id<MeshId>(scene.meshes.size()));
    scene.meshes.push_back(std::move(mesh));
  }
  return ids;
}

Loaded load_mesh(const MeshFile& file, LoadReport report, const std::filesystem::path& path,
                 const LoadOptions& options) {
  Loaded loaded{{}, std::move(report)};
  Materials materials(loaded.scene, loaded.report, {path.parent_path()});
  materials.add_folder(path.parent_path());
  for (const auto& script : options.material_scripts) materials.add_file(script);
  for (const auto& mesh : add_meshes(file, materials)) {
    if (mesh) loaded.scene.instances.push_back({*mesh, Mat4(1.0f), std::nullopt});
  }
  return loaded;
}

}  // namespace lantern::ogre
