// SPDX-License-Identifier: MIT
#include "lantern/scene/validate.h"

#include "lantern/core/error.h"
#include "lantern/scene/world.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>

namespace lantern {
namespace {

/// Collects what is wrong, so that one message names all of it (the first few).
class Findings {
 public:
  template <typename... Args>
  void add(fmt::format_string<Args...> text, Args&&... args) {
    constexpr std::size_t kNamed = 4;
    if (++count_ <= kNamed)
      text_ += (text_.empty() ? "" : "; ") + fmt::format(text, std::forward<Args>(args)...);
  }
  void throw_if_any(const std::string& file) const {
    if (count_ == 0) return;
    constexpr std::size_t kNamed = 4;
    throw Error(Place{file},
                count_ <= kNamed ? text_ : fmt::format("{}; and {} more", text_, count_ - kNamed));
  }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

bool is_finite(const Mat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}

std::string named(const char* kind, const std::string& name, std::size_t i) {
  return name.empty() ? fmt::format("{} {}", kind, i) : fmt::format("{} '{}'", kind, name);
}

void check_texture(Texture& texture, std::size_t i, Findings& findings,
                   std::vector<std::string>& warnings) {
  const std::string who = named("texture", texture.name, i);
  if (texture.width <= 0 || texture.height <= 0) {
    findings.add("{} has no texels", who);
    return;
  }
  const std::size_t values =
      4 * static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
  const bool one_kind = texture.srgb8.empty() != texture.linear.empty();
  if (!one_kind || texture.srgb8.size() + texture.linear.size() != values) {
    findings.add("{} is {}x{} but does not have that many texels", who, texture.width,
                 texture.height);
  }
  std::size_t bad = 0;
  for (float& value : texture.linear) {
    if (value >= 0.0f && std::isfinite(value)) continue;
    value = 0.0f;
    ++bad;
  }
  if (bad > 0) {
    warnings.push_back(
        fmt::format("{}: {} values are negative or not finite; taken as 0", who, bad));
  }
}

void check_material(Material& material, std::size_t i, std::size_t textures, Findings& findings,
                    std::vector<std::string>& warnings) {
  const std::string who = named("material", material.name, i);
  for (const auto& id : {material.reflectance_texture, material.emission_texture}) {
    if (id && index(*id) >= textures) findings.add("{} names a texture that is not there", who);
  }
  if (!lantern::is_finite(material.reflectance) || !std::isfinite(material.opacity) ||
      !std::isfinite(material.alpha_cutoff.value_or(0.0f))) {
    findings.add("{} has a reflectance or opacity that is not a finite number", who);
  }
  const Rgb clamped = glm::clamp(material.reflectance, 0.0f, 1.0f);
  if (clamped != material.reflectance) {
    warnings.push_back(fmt::format("{}: reflectance brought into [0, 1]", who));
    material.reflectance = clamped;
  }
  material.opacity = std::clamp(material.opacity, 0.0f, 1.0f);
  bool dark = false;
  for (int c = 0; c < 3; ++c) {
    if (material.emission[c] >= 0.0f && std::isfinite(material.emission[c])) continue;
    material.emission[c] = 0.0f;
    dark = true;
  }
  if (dark) {
    warnings.push_back(fmt::format("{}: emission is negative or not finite; taken as 0", who));
  }
}

void check_mesh(Mesh& mesh, std::size_t i, std::size_t materials, Findings& findings,
                std::vector<std::string>& warnings) {
  const std::string who = named("mesh", mesh.name, i);
  const std::size_t vertices = mesh.positions.size();
  if (index(mesh.material) >= materials) findings.add("{} names a material that is not there", who);
  for (std::size_t size : {mesh.normals.size(), mesh.texcoords.size(), mesh.colours.size()}) {
    if (size != 0 && size != vertices) {
      findings.add("{} has {} positions but {} values of another kind", who, vertices, size);
    }
  }
  const auto bad_position = std::find_if_not(mesh.positions.begin(), mesh.positions.end(),
                                             [](const Vec3& p) { return lantern::is_finite(p); });
  if (bad_position != mesh.positions.end()) {
    findings.add("{}: vertex {} is not at a finite place", who,
                 bad_position - mesh.positions.begin());
  }
  const auto bad_triangle = std::find_if(
      mesh.triangles.begin(), mesh.triangles.end(),
      [&](const uvec3& t) { return t.x >= vertices || t.y >= vertices || t.z >= vertices; });
  if (bad_triangle != mesh.triangles.end()) {
    findings.add("{}: triangle {} uses vertex {} of {}", who, bad_triangle - mesh.triangles.begin(),
                 std::max({bad_triangle->x, bad_triangle->y, bad_triangle->z}), vertices);
    return;
  }
  const std::size_t flat = std::erase_if(mesh.triangles, [&](const uvec3& t) {
    const Vec3 a = mesh.positions[t.x];
    return !has_area(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
  });
  if (flat > 0) {
    warnings.push_back(fmt::format("{}: {} triangles without area left out", who, flat));
  }
  for (Vec3& n : mesh.normals) {
    if (!lantern::is_finite(n)) n = Vec3(0.0f);
  }
  for (Vec2& t : mesh.texcoords) {
    if (!std::isfinite(t.x) || !std::isfinite(t.y)) t = Vec2(0.0f);
  }
  for (Vec4& c : mesh.colours) {
    if (!lantern::is_finite(Vec3(c)) || !std::isfinite(c.a)) c = Vec4(0.0f, 0.0f, 0.0f, 1.0f);
  }
}

void check_camera(Camera& camera, std::size_t i, Findings& findings) {
  const std::string who = named("camera", camera.name, i);
  if (!lantern::is_finite(camera.eye) || !lantern::is_finite(camera.forward) ||
      !lantern::is_finite(camera.up)) {
    findings.add("{} is not at a finite place", who);
    return;
  }
  const Vec3 right = glm::cross(camera.forward, camera.up);
  if (!(glm::dot(right, right) > 0.0f)) findings.add("{} looks along its own up vector", who);
  if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < kPi)) {
    findings.add("{} has a field of view outside (0, 180) degrees", who);
  }
}

void check_light(PunctualLight& light, std::size_t i, Findings& findings) {
  const std::string who = named("light", light.name, i);
  if (!lantern::is_finite(light.intensity) || glm::any(glm::lessThan(light.intensity, Rgb(0.0f)))) {
    findings.add("{} has an intensity that is negative or not finite", who);
  }
  if (!lantern::is_finite(light.position) || !lantern::is_finite(light.direction) ||
      !(glm::dot(light.direction, light.direction) > 0.0f)) {
    findings.add("{} has no finite place and direction", who);
  }
  if (!std::isfinite(light.inner_angle) || !std::isfinite(light.outer_angle)) {
    findings.add("{} has a cone that is not a finite angle", who);
    return;
  }
  light.outer_angle = std::clamp(light.outer_angle, 0.0f, kPi);
  light.inner_angle = std::clamp(light.inner_angle, 0.0f, light.outer_angle);
}

}  // namespace

std::vector<std::string> validate(Scene& scene, const std::string& file) {
  Findings findings;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    check_texture(scene.textures[i], i, findings, warnings);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_material(scene.materials[i], i, scene.textures.size(), findings, warnings);
  }
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    check_mesh(scene.meshes[i], i, scene.materials.size(), findings, warnings);
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (index(instance.mesh) >= scene.meshes.size() ||
        (instance.material && index(*instance.material) >= scene.materials.size())) {
      findings.add("instance {} names a mesh or material that is not there", i);
    } else if (!is_finite(instance.transform)) {
      findings.add("instance {} has a transform that is not finite", i);
    } else if (glm::row(instance.transform, 3) != Vec4(0.0f, 0.0f, 0.0f, 1.0f)) {
      findings.add("instance {} has a transform that is not affine", i);
    }
  }
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    check_camera(scene.cameras[i], i, findings);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) check_light(scene.lights[i], i, findings);
  if (scene.sky) {
    if (!lantern::is_finite(scene.sky->radiance) ||
        glm::any(glm::lessThan(scene.sky->radiance, Rgb(0.0f)))) {
      findings.add("the sky's radiance is negative or not finite");
    }
    if (scene.sky->texture && index(*scene.sky->texture) >= scene.textures.size()) {
      findings.add("the sky names a texture that is not there");
    }
  }
  findings.throw_if_any(file);
  return warnings;
}

}  // namespace lantern
