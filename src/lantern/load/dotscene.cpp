// SPDX-License-Identifier: MIT
#include "lantern/load/dotscene.h"

#include "lantern/core/file.h"
#include "lantern/load/ogre_binary.h"
#include "lantern/load/ogre_text.h"
#include "lantern/load/ogre_xml.h"

#include <algorithm>
#include <array>
#include <utility>

namespace lantern {
namespace ogre {
namespace {

using tinyxml2::XMLElement;

constexpr float kDefaultFov = 45.0f;

/// Where things lie, and hints to a rasteriser or an editor.
constexpr std::array<std::string_view, 14> kLeftOut{
    "position",          "rotation",       "quaternion",        "scale",
    "clipping",          "colourSpecular", "lightAttenuation",  "externals",
    "resourceLocations", "userData",       "userDataReference", "vertexBuffer",
    "indexBuffer",       "boneAttachments"};

bool is(const XMLElement& element, std::string_view name) { return element.Name() == name; }

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, LoadReport& report)
      : xml_(text, name, "scene"), report_(report) {}

  DotScene read() {
    const XMLElement& root = xml_.root();
    report_.format = "DotScene";
    const std::string version = xml_.text(root, "formatVersion");
    if (!version.empty()) report_.format += " " + version;
    if (xml_.number(root, "unitsPerMeter", 1.0f) != 1.0f) count("unitsPerMeter");
    if (xml_.text(root, "upAxis") == "z") count("upAxis");
    children(root, Mat4(1.0f));
    xml_.findings.throw_if_any();
    return std::move(scene_);
  }

 private:
  void count(std::string_view name) { ++report_.unknown[fmt::format("scene: {}", name)]; }

  void leave_out(const XMLElement& element) {
    const std::string_view name = element.Name();
    if (std::find(kLeftOut.begin(), kLeftOut.end(), name) == kLeftOut.end()) count(name);
  }

  /// Recursion ends because the elements of an XmlFile do.
  void children(const XMLElement& parent, const Mat4& transform) {
    for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "nodes") || is(*e, "node")) {
        children(*e, transform * local(*e));
      } else if (is(*e, "entity")) {
        entity(*e, transform);
      } else if (is(*e, "camera")) {
        camera(*e, transform * local(*e));
      } else if (is(*e, "light")) {
        light(*e, transform * local(*e));
      } else if (is(*e, "environment")) {
        environment(*e, transform);
      } else {
        leave_out(*e);
      }
    }
  }

  Mat4 local(const XMLElement& element) {
    Mat4 result(1.0f);
    if (const XMLElement* e = element.FirstChildElement("position")) {
      result = glm::translate(result, xml_.vector(*e));
    }
    const XMLElement* turn = element.FirstChildElement("rotation");
    if (!turn) turn = element.FirstChildElement("quaternion");
    if (turn) result = result * glm::mat4_cast(rotation(*turn));
    if (const XMLElement* e = element.FirstChildElement("scale")) {
      result = glm::scale(result, xml_.vector(*e, 1.0f));
    }
    return result;
  }

  Quat rotation(const XMLElement& e) {
    if (e.Attribute("angleX")) {
      // Degrees, about x, then y, then z of what the former have turned.
      const Vec3 a = glm::radians(Vec3(xml_.number(e, "angleX"), xml_.number(e, "angleY", 0.0f),
                                       xml_.number(e, "angleZ", 0.0f)));
      return glm::angleAxis(a.x, Vec3(1, 0, 0)) * glm::angleAxis(a.y, Vec3(0, 1, 0)) *
             glm::angleAxis(a.z, Vec3(0, 0, 1));
    }
    if (e.Attribute("angle")) {
      const Vec3 axis(xml_.number(e, "axisX"), xml_.number(e, "axisY"), xml_.number(e, "axisZ"));
      return glm::angleAxis(xml_.number(e, "angle"), unit(e, axis));
    }
    const bool has_q = e.Attribute("qw") || e.Attribute("qx");
    const Quat q(xml_.number(e, has_q ? "qw" : "w"), xml_.number(e, has_q ? "qx" : "x"),
                 xml_.number(e, has_q ? "qy" : "y"), xml_.number(e, has_q ? "qz" : "z"));
    const Vec4 n = unit(e, Vec4(q.w, q.x, q.y, q.z));
    return {n.x, n.y, n.z, n.w};
  }

  template <typename Vector>
  Vector unit(const XMLElement& element, const Vector& v) {
    const float length = glm::length(v);
    if (length > 0.0f && std::isfinite(length)) return v / length;
    xml_.findings.add(xml_.place(element), "<{}> has no direction", element.Name());
    Vector any(0.0f);
    any[0] = 1.0f;
    return any;
  }

  void entity(const XMLElement& element, const Mat4& transform) {
    Entity result;
    result.place = xml_.place(element);
    result.mesh_file = xml_.text(element, "meshFile");
    result.material = xml_.text(element, "materialFile");
    result.transform = transform;
    if (result.mesh_file.empty()) {
      xml_.findings.add(result.place, "the entity has no meshFile");
    }
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (!is(*e, "subentities")) {
        leave_out(*e);
        continue;
      }
      for (const XMLElement* s = e->FirstChildElement("subentity"); s;
           s = s->NextSiblingElement("subentity")) {
        const std::string material = xml_.text(*s, "materialName");
        if (!material.empty()) result.submesh_materials[xml_.count(*s, "index")] = material;
      }
    }
    if (xml_.flag(element, "visible", true)) scene_.entities.push_back(std::move(result));
  }

  static float radians(float angle) { return angle > kPi ? glm::radians(angle) : angle; }

  void camera(const XMLElement& element, const Mat4& transform) {
    Camera camera;
    camera.name = xml_.text(element, "name");
    camera.eye = Vec3(transform[3]);
    camera.forward = unit(element, -Vec3(transform[2]));
    camera.up = unit(element, Vec3(transform[1]));
    camera.vertical_fov = radians(xml_.number(element, "fov", kDefaultFov));
    if (xml_.text(element, "projectionType") == "orthographic") count("orthographic camera");
    leave_out_children(element);
    scene_.cameras.push_back(std::move(camera));
  }

  void light(const XMLElement& element, const Mat4& transform) {
    PunctualLight light;
    light.name = xml_.text(element, "name");
    const std::string type = xml_.text(element, "type");
    if (type == "spot" || type == "spotLight") {
      light.kind = PunctualKind::kSpot;
    } else if (type == "directional") {
      light.kind = PunctualKind::kDirectional;
    } else if (!type.empty() && type != "point" && type != "radPoint") {
      count(fmt::format("light of type {}", type));
    }
    light.position = Vec3(transform[3]);
    Vec3 direction(0.0f, 0.0f, -1.0f);
    const float power = xml_.number(element, "power", xml_.number(element, "powerScale", 1.0f));
    light.intensity = Rgb(power);
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "colourDiffuse")) {
        light.intensity = xml_.colour(*e) * power;
      } else if (is(*e, "normal") || is(*e, "direction") || is(*e, "directionVector")) {
        direction = xml_.vector(*e);
      } else if (is(*e, "lightRange")) {
        const float outer = xml_.number(*e, "outer");
        const float inner = std::min(xml_.number(*e, "inner", 0.0f), outer);
        light.outer_angle = 0.5f * radians(outer);
        // Both are in the unit that the larger one tells.
        light.inner_angle = 0.5f * (outer > kPi ? glm::radians(inner) : inner);
      } else {
        leave_out(*e);
      }
    }
    light.direction = unit(element, Mat3(transform) * direction);
    if (xml_.flag(element, "visible", true)) scene_.lights.push_back(std::move(light));
  }

  void environment(const XMLElement& element, const Mat4& transform) {
    const XMLElement* sky = element.FirstChildElement("colourAmbient");
    // Exporters that know no ambient light mean the background to shine.
    if (!sky) sky = element.FirstChildElement("colourBackground");
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (e == sky) {
        const Rgb radiance = xml_.colour(*e);
        if (!is_black(radiance)) scene_.sky = Sky{radiance, std::nullopt};
      } else if (is(*e, "camera")) {
        camera(*e, transform * local(*e));
      } else {
        leave_out(*e);
      }
    }
  }

  void leave_out_children(const XMLElement& element) {
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      leave_out(*e);
    }
  }

  XmlFile xml_;
  LoadReport& report_;
  DotScene scene_;
};

/// Finds files and brings a DotScene's entities into a Scene.
class Assembly {
 public:
  Assembly(Loaded& loaded, const std::filesystem::path& folder)
      : loaded_(loaded),
        folders_{folder,
                 folder / "models",
                 folder / "meshes",
                 folder / "materials",
                 folder / "materials" / "scripts",
                 folder / "materials" / "textures",
                 folder / "textures"},
        materials_(loaded.scene, loaded.report, folders_) {}

  void add(const std::vector<Entity>& entities, const LoadOptions& options) {
    std::vector<std::filesystem::path> files;
    std::vector<std::filesystem::path> script_folders = folders_;
    for (const Entity& entity : entities) {
      files.push_back(mesh_file(entity));
      script_folders.push_back(files.back().parent_path());
    }
    std::vector<std::string> known;
    for (const auto& folder : script_folders) {
      std::string name = folder.lexically_normal().string();
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      known.push_back(std::move(name));
      materials_.add_folder(folder);
    }
    for (const auto& script : options.material_scripts) materials_.add_file(script);
    for (std::size_t i = 0; i < entities.size(); ++i) add(entities[i], files[i]);
  }

 private:
  std::filesystem::path mesh_file(const Entity& entity) const {
    std::error_code ignored;
    for (const auto& folder : folders_) {
      for (const char* suffix : {"", ".xml"}) {
        auto file = folder / (entity.mesh_file + suffix);
        if (std::filesystem::is_regular_file(file, ignored)) return file;
      }
    }
    fail(entity.place, "mesh '{}' was not found", entity.mesh_file);
  }

  const std::vector<std::optional<MeshId>>& meshes_of(const std::filesystem::path& file) {
    const auto [found, is_new] = meshes_.try_emplace(file.lexically_normal().string());
    if (is_new) {
      std::string format = loaded_.report.format;
      const MeshFile mesh = extension(file) == ".xml"
                                ? parse_xml(read_text(file), file.string(), loaded_.report)
                                : parse_binary(read_file(file), file.string(), loaded_.report);
      loaded_.report.format = std::move(format);
      found->second = add_meshes(mesh, materials_);
    }
    return found->second;
  }

  void add(const Entity& entity, const std::filesystem::path& file) {
    const auto& meshes = meshes_of(file);
    // `materialFile` holds a material's name in most files, in some a script's.
    const bool names_script = extension(entity.material) == ".material";
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      if (!meshes[i]) continue;
      Instance instance{*meshes[i], entity.transform, std::nullopt};
      const auto own = entity.submesh_materials.find(static_cast<std::uint32_t>(i));
      if (own != entity.submesh_materials.end()) {
        instance.material = materials_.use(own->second);
      } else if (!entity.material.empty() && !names_script) {
        instance.material = materials_.use(entity.material);
      }
      loaded_.scene.instances.push_back(instance);
    }
  }

  Loaded& loaded_;
  std::vector<std::filesystem::path> folders_;
  Materials materials_;
  std::map<std::string, std::vector<std::optional<MeshId>>> meshes_;
};

}  // namespace

DotScene parse_dotscene(std::string_view text, const std::string& name, LoadReport& report) {
  return Reader(text, name, report).read();
}

}  // namespace ogre

Loaded load_dotscene(const std::filesystem::path& path, const LoadOptions& options) {
  Loaded loaded;
  ogre::DotScene parsed = ogre::parse_dotscene(read_text(path), path.string(), loaded.report);
  loaded.scene.cameras = std::move(parsed.cameras);
  loaded.scene.lights = std::move(parsed.lights);
  loaded.scene.sky = parsed.sky;
  ogre::Assembly(loaded, path.parent_path()).add(parsed.entities, options);
  return loaded;
}

}  // namespace lantern
