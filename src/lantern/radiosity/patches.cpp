// SPDX-License-Identifier: MIT
#include "lantern/radiosity/patches.h"

#include "lantern/core/error.h"
#include "lantern/core/memory.h"
#include "lantern/core/parallel.h"
#include "lantern/radiosity/exposure.h"
#include "lantern/radiosity/random.h"
#include "lantern/radiosity/smoothing.h"
#include "lantern/radiosity/t_junctions.h"
#include "lantern/scene/surface.h"

#include <algorithm>
#include <cmath>

namespace lantern {
namespace {

constexpr std::size_t kGrain = 16;
constexpr std::size_t kMostPatches = 16'000'000;
/// What a patch takes at the worst moment, with the tree that tells patches apart: 16 million were
/// seen to fill 23 GB.
constexpr std::uint64_t kBytesPerPatch = 1536;
/// A vertex so near to an edge, relative to coordinates, is on it: sixteen roundings of these.
constexpr double kOnEdge = 0x1p-20;

const Material& material_of(const Scene& scene, const World& world, std::uint32_t triangle) {
  return scene.materials[index(world.materials[triangle])];
}

/// Calls visit(place) for the centroids of the n² equal triangles that a face falls into; `place`
/// are barycentric weights in the face's source.
template <typename Visit>
void for_parts(const PatchMesh::Face& face, int n, Visit visit) {
  const auto at = [&](double u, double v) {
    return Vec2(face.places[0] * (1.0 - u - v) + face.places[1] * u + face.places[2] * v);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      visit(at((i + 1.0 / 3.0) / n, (j + 1.0 / 3.0) / n));
      if (i + j + 1 < n) visit(at((i + 2.0 / 3.0) / n, (j + 2.0 / 3.0) / n));
    }
  }
}

/// How finely a face must be cut for the means of its textures: about a part for each texel.
int parts_along_edge(const Scene& scene, const World& world, const PatchMesh::Face& face) {
  constexpr int kLeast = 4, kMost = 32;
  const Material& material = material_of(scene, world, face.source);
  if (world.texcoords.empty()) return kLeast;
  const uvec3 v = world.triangles[face.source];
  float texels = 0.0f;
  for (const auto& id : {material.reflectance_texture, material.emission_texture}) {
    if (!id) continue;
    const Texture& texture = scene.textures[index(*id)];
    const Vec2 size(texture.width, texture.height);
    Vec2 low(kInfinity), high(-kInfinity);
    for (const glm::dvec2& place : face.places) {
      const Vec2 w(place);
      const Vec2 uv = world.texcoords[v.x] * (1.0f - w.x - w.y) + world.texcoords[v.y] * w.x +
                      world.texcoords[v.z] * w.y;
      low = glm::min(low, uv * size);
      high = glm::max(high, uv * size);
    }
    texels = std::max({texels, high.x - low.x, high.y - low.y});
  }
  if (!(texels < static_cast<float>(kMost))) return kMost;
  return std::max(kLeast, static_cast<int>(std::ceil(texels)));
}

bool varies(const Scene& scene, const World& world, std::uint32_t triangle) {
  const Material& material = material_of(scene, world, triangle);
  return material.reflectance_texture || material.emission_texture ||
         (material.vertex_colours && !world.colours.empty());
}

struct Means {
  glm::dvec3 reflectance{0.0}, front{0.0}, back{0.0};  // radiances of the two sides
};

Means means_of(const Scene& scene, const World& world, const PatchMesh::Face& face) {
  Means sum;
  int count = 0;
  const std::uint32_t t = face.source;
  const int n = varies(scene, world, t) ? parts_along_edge(scene, world, face) : 1;
  for_parts(face, n, [&](Vec2 place) {
    // A hole of a share of the area lets through that share of what would be reflected.
    const double covered = static_cast<double>(coverage_at(scene, world, t, place));
    sum.reflectance += covered * glm::dvec3(surface_at(scene, world, t, place).reflectance);
    sum.front += covered * glm::dvec3(emission_at(scene, world, t, place, true));
    sum.back += covered * glm::dvec3(emission_at(scene, world, t, place, false));
    ++count;
  });
  return {sum.reflectance / static_cast<double>(count), sum.front / static_cast<double>(count),
          sum.back / static_cast<double>(count)};
}

/// The share of a side that no solid covers.
double exposed_share(const World& world, const Tracer& tracer, const Patches& patches,
                     std::size_t element) {
  const PatchMesh::Face& face = patches.mesh.faces[patches.patch[element]];
  const uvec3 v = world.triangles[face.source];
  const Vec3 normal(patches.element_normal(element));
  const auto share = [&](int n) {
    int count = 0, open = 0;
    for_parts(face, n, [&](Vec2 place) {
      const Vec3 position = world.positions[v.x] * (1.0f - place.x - place.y) +
                            world.positions[v.y] * place.x + world.positions[v.z] * place.y;
      const std::uint64_t key = hash(element, static_cast<std::uint64_t>(count++));
      if (!is_covered(world, patches.lit, tracer, position, normal, key)) ++open;
    });
    return static_cast<double>(open) / count;
  };
  constexpr int kCoarse = 4, kFine = 16;
  const double coarse = share(kCoarse);
  return coarse == 0.0 || coarse == 1.0 ? coarse : share(kFine);
}

void require_reflectance_below_one(const Scene& scene, const World& world, const Patches& patches) {
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const glm::dvec3 rho = patches.reflectance[i];
    if (glm::all(glm::lessThan(rho, glm::dvec3(1.0)))) continue;
    const Material& material = material_of(scene, world, patches.mesh.faces[i].source);
    throw Error(fmt::format(
        "material '{}' reflects all light (reflectance {:.3g}, {:.3g}, {:.3g}): radiosity needs "
        "reflectances below 1",
        material.name, rho.r, rho.g, rho.b));
  }
}

}  // namespace

void require_patch_memory(std::size_t count) {
  require_memory(count * kBytesPerPatch, fmt::format("{} patches", count), "ask for fewer");
}

Patches make_patches(const Scene& scene, const World& world, const Tracer& tracer, PatchMesh mesh,
                     LitSides lit) {
  if (mesh.size() == 0) throw Error("the scene has no triangles");
  Patches patches;
  patches.mesh = std::move(mesh);
  const std::size_t count = patches.mesh.size();
  patches.area.resize(count);
  patches.normal.resize(count);
  patches.centre.resize(count);
  patches.reflectance.resize(count);
  patches.back.assign(count, kNoElement);
  patches.emission.resize(count);
  patches.patch.resize(count);
  std::vector<glm::dvec3> back_emission(count);
  parallel_for(count, kGrain, [&](std::size_t i) {
    const PatchMesh& m = patches.mesh;
    const Means means = means_of(scene, world, m.faces[i]);
    const glm::dvec3 area_vector = m.area_vector(i);
    patches.area[i] = 0.5 * glm::length(area_vector);
    patches.normal[i] = glm::normalize(glm::dvec3(world.area_vector(m.faces[i].source)));
    patches.centre[i] = (m.corner(i, 0) + m.corner(i, 1) + m.corner(i, 2)) / 3.0;
    patches.reflectance[i] = means.reflectance;
    patches.emission[i] = glm::pi<double>() * means.front;
    back_emission[i] = glm::pi<double>() * means.back;
    patches.patch[i] = static_cast<std::uint32_t>(i);
  });
  require_reflectance_below_one(scene, world, patches);

  patches.lit = std::move(lit);
  for (std::size_t i = 0; i < count; ++i) {
    if (!patches.lit(patches.mesh.faces[i].source, false)) continue;
    patches.back[i] = static_cast<std::uint32_t>(patches.elements());
    patches.patch.push_back(static_cast<std::uint32_t>(i));
    patches.emission.push_back(back_emission[i]);
  }
  const auto all_lit = [](const std::vector<bool>& sides) {
    return std::find(sides.begin(), sides.end(), false) == sides.end();
  };
  patches.exposed.assign(patches.elements(), 1.0);
  if (!all_lit(patches.lit.front) || !all_lit(patches.lit.back)) {
    parallel_for(patches.elements(), kGrain, [&](std::size_t e) {
      const std::uint32_t triangle = patches.mesh.faces[patches.patch[e]].source;
      patches.exposed[e] = patches.lit(triangle, patches.is_front(e))
                               ? exposed_share(world, tracer, patches, e)
                               : 0.0;
    });
  }
  SmoothVertices smooth = smooth_vertices(world, patches.mesh);
  patches.smooth_vertices = std::move(smooth.of_corner);
  patches.smooth_vertex_count = smooth.count;
  return patches;
}

Patches make_patches(const Scene& scene, const World& world, const Tracer& tracer,
                     const PatchOptions& options) {
  PatchMesh mesh = make_patch_mesh(world);
  LitSides lit = lit_sides(scene, world, mesh, tracer);
  close_t_junctions(mesh, kOnEdge * static_cast<double>(world.coordinate_scale()));
  LeftAlone dark(world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) dark[t] = !lit(t, true) && !lit(t, false);
  if (options.size) {
    const std::uint64_t room = available_bytes() / kBytesPerPatch;
    refine_to_size(mesh, *options.size, std::min<std::uint64_t>(kMostPatches, room), dark);
  } else {
    require_patch_memory(options.count);
    refine_to_count(mesh, options.count, dark);
  }
  return make_patches(scene, world, tracer, std::move(mesh), std::move(lit));
}

World patch_world(const World& world, const Patches& patches) {
  World result;
  result.bounds = world.bounds;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const PatchMesh::Face& face = patches.mesh.faces[i];
    const uvec3 v = world.triangles[face.source];
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    result.triangles.emplace_back(first, first + 1, first + 2);
    result.materials.push_back(world.materials[face.source]);
    for (int k = 0; k < 3; ++k) {
      const Vec2 w(face.places[static_cast<std::size_t>(k)]);
      const auto at = [&](const auto& values) {
        return values[v.x] * (1.0f - w.x - w.y) + values[v.y] * w.x + values[v.z] * w.y;
      };
      result.positions.emplace_back(patches.mesh.corner(i, k));
      if (!world.texcoords.empty()) result.texcoords.push_back(at(world.texcoords));
      if (!world.colours.empty()) result.colours.push_back(at(world.colours));
    }
  }
  return result;
}

}  // namespace lantern
