// SPDX-License-Identifier: MIT
#include "lantern/lights/export.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/core/version.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace lantern {
namespace {

using Json = nlohmann::json;

constexpr std::array kKindNames = {"surface", "point", "spot", "directional"};

/// The shortest digits that read back as the same float. JSON takes "-0" for an integer, which has
/// no sign at zero.
std::string digits(float value) {
  return value == 0.0f && std::signbit(value) ? "-0.0" : fmt::format("{}", value);
}

/// A position in the file's coordinates: the sum in double precision, which loses nothing.
std::string place(const Vec3& position, const Vec3& origin) {
  const auto axis = [&](int i) {
    return origin[i] == 0.0f ? digits(position[i])
                             : fmt::format("{}", static_cast<double>(position[i]) +
                                                     static_cast<double>(origin[i]));
  };
  return fmt::format("[{},{},{}]", axis(0), axis(1), axis(2));
}

std::string triple(const Vec3& v) {
  return fmt::format("[{},{},{}]", digits(v.x), digits(v.y), digits(v.z));
}

/// One light of the file; its errors name the light.
class LightReader {
 public:
  LightReader(const Json& light, std::size_t i, const std::string& file)
      : light_(light), i_(i), file_(file) {
    if (!light.is_object()) refuse("is no object");
  }

  Vec3 vector(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array() || value.size() != 3)
      refuse(fmt::format("'{}' is not three numbers", key));
    return {number(value[0], key), number(value[1], key), number(value[2], key)};
  }

  /// The inverse of place().
  Vec3 position(const Vec3& origin) const {
    const Json& value = member("position");
    Vec3 position = vector("position");
    for (int i = 0; i < 3; ++i) {
      if (origin[i] == 0.0f) continue;
      position[i] = static_cast<float>(value[static_cast<std::size_t>(i)].get<double>() -
                                       static_cast<double>(origin[i]));
    }
    return position;
  }

  Vec2 pair(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array() || value.size() != 2) refuse(fmt::format("'{}' is not two numbers", key));
    return {number(value[0], key), number(value[1], key)};
  }

  std::uint32_t count(const char* key) const {
    const Json& value = member(key);
    if (!value.is_number_unsigned() ||
        value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
      refuse(fmt::format("'{}' is no count", key));
    }
    return value.get<std::uint32_t>();
  }

  LightKind kind() const {
    if (!light_.contains("kind")) return LightKind::kSurface;
    const Json& value = light_["kind"];
    for (std::size_t k = 0; k < kKindNames.size(); ++k) {
      if (value.is_string() && value.get_ref<const std::string&>() == kKindNames[k]) {
        return static_cast<LightKind>(k);
      }
    }
    refuse("'kind' is not surface, point, spot or directional");
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(Place{file_}, fmt::format("light {}: {}", i_, what));
  }

 private:
  const Json& member(const char* key) const {
    const auto found = light_.find(key);
    if (found == light_.end()) refuse(fmt::format("has no '{}'", key));
    return *found;
  }

  float number(const Json& value, const char* key) const {
    const float number = value.is_number() ? value.get<float>() : kInfinity;
    if (!std::isfinite(number)) refuse(fmt::format("'{}' is not finite numbers", key));
    return number;
  }

  const Json& light_;
  std::size_t i_;
  const std::string& file_;
};

/// The rotation that takes glTF's light axis -z to `direction`, as x, y, z, w.
Vec4 rotation_to(const Vec3& direction) {
  const Vec3 from(0.0f, 0.0f, -1.0f);
  const float w = 1.0f + glm::dot(from, direction);
  constexpr float kOpposite = 1e-6f;
  if (w < kOpposite) return {1.0f, 0.0f, 0.0f, 0.0f};
  return glm::normalize(Vec4(glm::cross(from, direction), w));
}

}  // namespace

std::string to_json(const VirtualLights& lights, const Vec3& origin) {
  fmt::memory_buffer out;
  const auto sink = std::back_inserter(out);
  fmt::format_to(sink, "{{\"paths\": {}, \"reflectivity\": {}, \"lights\": [", lights.paths,
                 lights.reflectivity);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    fmt::format_to(
        sink, "{}\n{{\"position\": {}, \"normal\": {}, \"flux\": {}, \"path\": {}, \"bounce\": {}",
        i == 0 ? "" : ",", place(lights.position[i], origin), triple(lights.normal[i]),
        triple(lights.flux[i]), lights.path[i], lights.bounce[i]);
    if (lights.kind[i] != LightKind::kSurface) {
      fmt::format_to(sink, ", \"kind\": \"{}\"",
                     kKindNames[static_cast<std::size_t>(lights.kind[i])]);
    }
    if (lights.kind[i] == LightKind::kSpot) {
      fmt::format_to(sink, ", \"cone\": [{},{}]", digits(lights.cone[i].x),
                     digits(lights.cone[i].y));
    }
    fmt::format_to(sink, "}}");
  }
  fmt::format_to(sink, "\n]}}\n");
  return fmt::to_string(out);
}

VirtualLights lights_from_json(std::string_view text, const std::string& name, const Vec3& origin) {
  Json file;
  try {
    file = Json::parse(text);
  } catch (const Json::parse_error& e) {
    throw Error(Place{.file = name, .byte = e.byte}, "is not JSON");
  } catch (const Json::exception&) {
    throw Error(Place{name}, "holds a number out of range");
  }
  if (!file.is_object() || !file.contains("lights") || !file["lights"].is_array()) {
    throw Error(Place{name}, "has no array 'lights'");
  }
  VirtualLights lights;
  const Json& paths = file.value("paths", Json(0));
  const Json& reflectivity = file.value("reflectivity", Json(0.0));
  if (!paths.is_number_unsigned() || !reflectivity.is_number()) {
    throw Error(Place{name}, "'paths' or 'reflectivity' is not a number");
  }
  lights.paths = paths.get<std::size_t>();
  lights.reflectivity = reflectivity.get<float>();
  const Json& list = file["lights"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const LightReader reader(list[i], i, name);
    const LightKind kind = reader.kind();
    const Vec3 normal = reader.vector("normal");
    const Rgb flux = reader.vector("flux");
    constexpr float kUnitTolerance = 1e-3f;  // six digits written by another program pass
    if (std::abs(glm::length(normal) - 1.0f) > kUnitTolerance) {
      reader.refuse("'normal' is not of unit length");
    }
    if (glm::any(glm::lessThan(flux, Rgb(0.0f)))) reader.refuse("'flux' is negative");
    lights.kind.push_back(kind);
    lights.position.push_back(reader.position(origin));
    lights.normal.push_back(normal);
    lights.flux.push_back(flux);
    lights.path.push_back(reader.count("path"));
    lights.bounce.push_back(reader.count("bounce"));
    lights.cone.push_back(kind == LightKind::kSpot ? reader.pair("cone") : Vec2(0.0f));
  }
  return lights;
}

std::string to_ply(const VirtualLights& lights, const Vec3& origin) {
  float brightest = 0.0f;
  for (const Rgb& flux : lights.flux) brightest = std::max(brightest, max_component(flux));
  fmt::memory_buffer out;
  const auto sink = std::back_inserter(out);
  fmt::format_to(sink,
                 "ply\nformat ascii 1.0\ncomment Lantern {}: virtual point lights, flux in W\n"
                 "element vertex {}\n",
                 kVersion, lights.size());
  for (const char* property : {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                               "float flux_r", "float flux_g", "float flux_b", "uint path",
                               "uint bounce", "uchar red", "uchar green", "uchar blue"}) {
    fmt::format_to(sink, "property {}\n", property);
  }
  fmt::format_to(sink, "end_header\n");
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Vec3 p = lights.position[i] + origin, n = lights.normal[i];
    const Rgb f = lights.flux[i];
    const auto channel = [&](float value) {
      return brightest > 0.0f ? std::lround(255.0f * std::sqrt(value / brightest)) : 0;
    };
    fmt::format_to(sink, "{} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y,
                   n.z, f.r, f.g, f.b, lights.path[i], lights.bounce[i], channel(f.r), channel(f.g),
                   channel(f.b));
  }
  return fmt::to_string(out);
}

std::string to_gltf(const VirtualLights& lights, const Vec3& origin) {
  Json list = Json::array(), nodes = Json::array(), roots = Json::array();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Rgb flux = lights.flux[i];
    const LightKind kind = lights.kind[i];
    const float solid_angle = kind == LightKind::kSurface ? kPi
                              : kind == LightKind::kPoint ? 4.0f * kPi
                              : kind == LightKind::kSpot  ? spot_solid_angle(lights.cone[i])
                                                          : 1.0f;
    const float strongest = max_component(flux);
    const Rgb colour = strongest > 0.0f ? flux / strongest : Rgb(1.0f);
    Json light = {{"color", {colour.r, colour.g, colour.b}},
                  {"intensity", strongest / solid_angle}};
    switch (kind) {
      case LightKind::kSurface:
        light["type"] = "spot";
        // In double precision: the float next to it is above the limit of a right angle.
        light["spot"] = {{"innerConeAngle", 0.0f}, {"outerConeAngle", 0.5 * std::numbers::pi}};
        break;
      case LightKind::kSpot:
        light["type"] = "spot";
        light["spot"] = {{"innerConeAngle", std::acos(std::clamp(lights.cone[i].x, -1.0f, 1.0f))},
                         {"outerConeAngle", std::acos(std::clamp(lights.cone[i].y, -1.0f, 1.0f))}};
        break;
      case LightKind::kPoint:
        light["type"] = "point";
        break;
      case LightKind::kDirectional:
        light["type"] = "directional";
        break;
    }
    const Vec3 p = lights.position[i] + origin;
    const Vec4 q = rotation_to(lights.normal[i]);
    nodes.push_back({{"name", fmt::format("path {} bounce {}", lights.path[i], lights.bounce[i])},
                     {"translation", {p.x, p.y, p.z}},
                     {"rotation", {q.x, q.y, q.z, q.w}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    list.push_back(std::move(light));
    roots.push_back(i);
  }
  Json file = {{"asset", {{"version", "2.0"}, {"generator", fmt::format("Lantern {}", kVersion)}}},
               {"scenes", {Json::object()}},
               {"scene", 0}};
  // glTF allows no empty arrays.
  if (lights.size() > 0) {
    file["extensionsUsed"] = {"KHR_lights_punctual"};
    file["extensions"] = {{"KHR_lights_punctual", {{"lights", list}}}};
    file["nodes"] = nodes;
    file["scenes"] = {{{"nodes", roots}}};
  }
  return file.dump(1) + "\n";
}

void require_lights_format(const std::filesystem::path& path) {
  const std::string kind = extension(path);
  if (kind != ".json" && kind != ".ply" && kind != ".gltf") {
    fail({path.string()}, "lights are written as .json, .ply or .gltf");
  }
}

void write_lights(const std::filesystem::path& path, const VirtualLights& lights,
                  const Vec3& origin) {
  require_lights_format(path);
  const std::string kind = extension(path);
  write_file(path, kind == ".json"  ? to_json(lights, origin)
                   : kind == ".ply" ? to_ply(lights, origin)
                                    : to_gltf(lights, origin));
}

VirtualLights read_lights(const std::filesystem::path& path, const Vec3& origin) {
  return lights_from_json(read_text(path), path.string(), origin);
}

}  // namespace lantern
