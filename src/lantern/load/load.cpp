// SPDX-License-Identifier: MIT
#include "lantern/load/load.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/load/assimp_scene.h"
#include "lantern/load/dotscene.h"
#include "lantern/load/gltf_scene.h"
#include "lantern/load/ogre_binary.h"
#include "lantern/load/ogre_xml.h"
#include "lantern/scene/validate.h"

#include <algorithm>
#include <utility>

namespace lantern {
namespace {

Loaded load_by_name(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string last = extension(path);
  if (last == ".xml") return load_ogre_xml(path, options);
  if (last == ".mesh") return load_ogre_binary(path, options);
  if (last == ".scene") return load_dotscene(path, options);
  if (last == ".gltf" || last == ".glb") return load_gltf(path, options);
  return load_assimp(path, options);
}

/// Lengths become metres, and the lights without area keep the picture as it is: what a point
/// light sends to a surface falls with the square of the distance.
void apply_unit(Scene& scene, float unit) {
  for (Mesh& mesh : scene.meshes) {
    for (Vec3& p : mesh.positions) p *= unit;
  }
  for (Instance& instance : scene.instances) {
    instance.transform[3] = Vec4(Vec3(instance.transform[3]) * unit, instance.transform[3].w);
  }
  for (Camera& camera : scene.cameras) camera.eye *= unit;
  for (PunctualLight& light : scene.lights) {
    light.position *= unit;
    if (light.kind != PunctualKind::kDirectional) light.intensity *= unit * unit;
  }
}

/// Where coordinates are much larger than the scene, their rounding would be seen in the picture:
/// the middle of the scene becomes the origin.
void move_near_zero(Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    for (const Vec3& p : scene.meshes[index(instance.mesh)].positions) {
      bounds.add(Vec3(instance.transform * Vec4(p, 1.0f)));
    }
  }
  constexpr float kFar = 16.0f;  // radii
  if (bounds.empty() || !(glm::length(bounds.centre()) > kFar * bounds.radius())) return;
  const Vec3 centre = bounds.centre();
  if (!is_finite(centre)) return;
  for (Instance& instance : scene.instances) instance.transform[3] -= Vec4(centre, 0.0f);
  for (Camera& camera : scene.cameras) camera.eye -= centre;
  for (PunctualLight& light : scene.lights) light.position -= centre;
  scene.origin += centre;
}

bool has_triangles(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return !scene.meshes[index(instance.mesh)].triangles.empty();
  });
}

}  // namespace

void LoadReport::warn(std::string text) {
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
    warnings.push_back(std::move(text));
  }
}

Loaded load_scene(const std::filesystem::path& path, const LoadOptions& options) {
  if (!(options.unit > 0.0f) || !std::isfinite(options.unit)) {
    throw Error(fmt::format("a unit of {} metres is not a length", options.unit));
  }
  Loaded loaded = load_by_name(path, options);
  if (options.unit != 1.0f) apply_unit(loaded.scene, options.unit);
  for (std::string& warning : validate(loaded.scene, path.string())) {
    loaded.report.warn(std::move(warning));
  }
  if (!has_triangles(loaded.scene)) fail({path.string()}, "has no triangles");
  move_near_zero(loaded.scene);
  return loaded;
}

}  // namespace lantern
