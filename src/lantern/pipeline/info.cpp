// SPDX-License-Identifier: MIT
#include "lantern/pipeline/info.h"

#include "lantern/lights/emitters.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/world.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>

namespace lantern {
namespace {

/// All emitting triangles of one material.
struct AreaEmitter {
  std::string material;
  std::size_t triangles = 0;
  double area = 0.0;     // m², of one side
  glm::dvec3 flux{0.0};  // W, of all emitting sides
};

struct Summary {
  World world;
  std::size_t instances = 0;
  std::vector<AreaEmitter> emitters;
  float reflectivity = 0.0f;
};

Summary summarise(const Scene& scene) {
  Summary summary;
  summary.world = make_world(scene);
  summary.instances = scene.instances.size();
  summary.reflectivity = mean_reflectivity(scene, summary.world);
  std::map<std::size_t, AreaEmitter> by_material;
  for (std::uint32_t t = 0; t < summary.world.size(); ++t) {
    const std::size_t m = index(summary.world.materials[t]);
    const Material& material = scene.materials[m];
    if (is_black(material.emission)) continue;
    AreaEmitter& emitter = by_material[m];
    emitter.material = material.name;
    ++emitter.triangles;
    emitter.area += static_cast<double>(summary.world.area(t));
    emitter.flux += glm::dvec3(triangle_flux(scene, summary.world, t, true));
    if (material.double_sided) {
      emitter.flux += glm::dvec3(triangle_flux(scene, summary.world, t, false));
    }
  }
  for (auto& [m, emitter] : by_material) summary.emitters.push_back(std::move(emitter));
  return summary;
}

const char* name_of(PunctualKind kind) {
  switch (kind) {
    case PunctualKind::kPoint:
      return "point";
    case PunctualKind::kSpot:
      return "spot";
    case PunctualKind::kDirectional:
      break;
  }
  return "directional";
}

std::string text_of(const Vec3& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }

nlohmann::json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::string describe(const Loaded& loaded) {
  const Scene& scene = loaded.scene;
  const Summary s = summarise(scene);
  std::string out;
  const auto line = [&](const char* key, const std::string& value) {
    out += fmt::format("{:<14}{}\n", key, value);
  };
  line("format", loaded.report.format);
  line("triangles", fmt::format("{} in {} instances of {} meshes", s.world.size(), s.instances,
                                scene.meshes.size()));
  if (!s.world.bounds.empty()) {
    line("bounds", fmt::format("{} to {} m", text_of(s.world.bounds.low + scene.origin),
                               text_of(s.world.bounds.high + scene.origin)));
  }
  line("reflectivity", fmt::format("{:.4f} (area-weighted mean)", s.reflectivity));
  for (const Material& m : scene.materials) {
    line(
        "material",
        fmt::format(
            "{}  reflectance {}{}{}{}", m.name, text_of(m.reflectance),
            m.reflectance_texture ? " x " + scene.textures[index(*m.reflectance_texture)].name : "",
            m.alpha_cutoff ? "  alpha mask" : "", m.double_sided ? "  double-sided" : ""));
  }
  for (const AreaEmitter& e : s.emitters) {
    line("emitter", fmt::format("{}  {} triangles, {:.4g} m2, flux {} W", e.material, e.triangles,
                                e.area, text_of(Vec3(e.flux))));
  }
  for (const PunctualLight& l : scene.lights) {
    line("light",
         fmt::format("{}  {}, intensity {} {}", l.name, name_of(l.kind), text_of(l.intensity),
                     l.kind == PunctualKind::kDirectional ? "W/m2" : "W/sr"));
  }
  if (scene.sky) {
    line("sky",
         fmt::format(
             "radiance {}{}", text_of(scene.sky->radiance),
             scene.sky->texture ? " x " + scene.textures[index(*scene.sky->texture)].name : ""));
  }
  for (const Camera& c : scene.cameras) {
    line("camera", fmt::format("{}  at {} looking along {}, {:.4g} degrees high", c.name,
                               text_of(c.eye + scene.origin), text_of(c.forward),
                               glm::degrees(c.vertical_fov)));
  }
  for (const auto& [what, times] : loaded.report.unknown) {
    line("unknown", fmt::format("{} ({} times)", what, times));
  }
  for (const std::string& warning : loaded.report.warnings) line("warning", warning);
  return out;
}

std::string describe_as_json(const Loaded& loaded) {
  using Json = nlohmann::json;
  const Scene& scene = loaded.scene;
  const Summary s = summarise(scene);
  Json out = {{"format", loaded.report.format},
              {"triangles", s.world.size()},
              {"instances", s.instances},
              {"meshes", scene.meshes.size()},
              {"mean_reflectivity", s.reflectivity},
              {"materials", Json::array()},
              {"textures", Json::array()},
              {"emitters", Json::array()},
              {"lights", Json::array()},
              {"cameras", Json::array()},
              {"unknown", loaded.report.unknown},
              {"warnings", loaded.report.warnings}};
  if (!s.world.bounds.empty()) {
    out["bounds"] = {{"low", json_of(s.world.bounds.low + scene.origin)},
                     {"high", json_of(s.world.bounds.high + scene.origin)}};
  }
  for (const Material& m : scene.materials) {
    Json material = {{"name", m.name},
                     {"reflectance", json_of(m.reflectance)},
                     {"emission", json_of(m.emission)},
                     {"double_sided", m.double_sided}};
    if (m.reflectance_texture) {
      material["texture"] = scene.textures[index(*m.reflectance_texture)].name;
    }
    if (m.alpha_cutoff) material["alpha_cutoff"] = *m.alpha_cutoff;
    out["materials"].push_back(std::move(material));
  }
  for (const Texture& t : scene.textures) {
    out["textures"].push_back({{"name", t.name}, {"width", t.width}, {"height", t.height}});
  }
  for (const AreaEmitter& e : s.emitters) {
    out["emitters"].push_back({{"material", e.material},
                               {"triangles", e.triangles},
                               {"area", e.area},
                               {"flux", json_of(e.flux)}});
  }
  for (const PunctualLight& l : scene.lights) {
    out["lights"].push_back({{"name", l.name},
                             {"kind", name_of(l.kind)},
                             {"intensity", json_of(l.intensity)},
                             {"position", json_of(l.position + scene.origin)},
                             {"direction", json_of(l.direction)}});
  }
  if (scene.sky) {
    out["sky"] = {{"radiance", json_of(scene.sky->radiance)}};
    if (scene.sky->texture) out["sky"]["file"] = scene.textures[index(*scene.sky->texture)].name;
  }
  for (const Camera& c : scene.cameras) {
    out["cameras"].push_back({{"name", c.name},
                              {"eye", json_of(c.eye + scene.origin)},
                              {"forward", json_of(c.forward)},
                              {"up", json_of(c.up)},
                              {"vertical_fov_degrees", glm::degrees(c.vertical_fov)}});
  }
  // Names come from files: what is no UTF-8 in them must not stop the report.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lantern
