// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/core/hash.h"
#include "lantern/lights/export.h"
#include "lantern/lights/walk.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/render_instant_radiosity.h"

#include "tests/analytic/rooms.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <numbers>
#include <sstream>

namespace lantern {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

// --- make_survival()
// --------------------------------------------------------------------------------------

TEST(Survival, OfTheFirstPassIsKellers) {
  EXPECT_THAT(make_survival(60, 0.6f, 0).paths, ElementsAre(60, 36, 21, 12, 7, 4, 2, 1));
  EXPECT_THAT(make_survival(1, 0.5f, 0).paths, ElementsAre(1));
  // 0.6 is a float a little above or below: 0.6 · 5 is 3.
  EXPECT_THAT(make_survival(5, 0.6f, 0).paths, ElementsAre(5, 3, 1));
}

TEST(Survival, NeverGrowsAndWeighsByTheCountWhileItIsSure) {
  for (const std::size_t paths : {1, 2, 16, 60, 1000}) {
    for (const float p : {0.05f, 0.5f, 0.95f}) {
      for (std::size_t pass = 0; pass < 200; ++pass) {
        const Survival s = make_survival(paths, p, pass);
        ASSERT_EQ(s.paths.size(), s.weight.size());
        ASSERT_EQ(s.paths[0], paths);
        bool sure = true;
        for (std::size_t j = 1; j < s.paths.size(); ++j) {
          ASSERT_GT(s.paths[j], 0u);
          ASSERT_LE(s.paths[j], s.paths[j - 1]);
          const double expected = static_cast<double>(p) * static_cast<double>(s.paths[j - 1]);
          ASSERT_LT(std::abs(static_cast<double>(s.paths[j]) - expected), 1.0 + 1e-5);
          sure &= expected >= 1.0;
          if (sure) {
            ASSERT_NEAR(s.weight[j] * static_cast<double>(s.paths[j]), 1.0, 1e-12);
          }
        }
      }
    }
  }
}

// --- lights as JSON
// ---------------------------------------------------------------------------------------

float number(std::uint64_t stream, std::uint64_t i) {
  // Over many magnitudes, signs included.
  const float u = to_unit_float(hash(stream, i));
  return std::ldexp(2.0f * u - 1.0f, static_cast<int>(hash(stream + 1, i) % 40) - 20);
}

VirtualLights lights_of_all_kinds(std::uint32_t count) {
  VirtualLights lights;
  lights.paths = 123456789012;
  lights.reflectivity = 0.123456789f;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto kind = static_cast<LightKind>(i % 4);
    lights.kind.push_back(kind);
    lights.position.emplace_back(number(1, i), number(3, i), -0.0f);
    lights.normal.push_back(
        i % 3 == 0 ? Vec3(-0.0f, 1.0f, -0.0f)
                   : glm::normalize(Vec3(number(5, 2), number(7, i), number(9, i)) + 1e-6f));
    lights.flux.emplace_back(std::abs(number(11, i)), std::abs(number(13, i)), 0.0f);
    lights.path.push_back(i == 5 ? 4294967295u : i);
    lights.bounce.push_back(i % 7);
    lights.cone.push_back(kind == LightKind::kSpot ? Vec2(0.1f + 0.2f, -0.7f) : Vec2(0.0f));
  }
  return lights;
}

void expect_same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(a[i][c]), std::bit_cast<std::uint32_t>(b[i][c]))
          << "value " << i << ": " << a[i][c] << " and " << b[i][c];
    }
  }
}

TEST(LightsJson, ReadsBackToTheSameBits) {
  const VirtualLights lights = lights_of_all_kinds(500);
  const VirtualLights back = lights_from_json(to_json(lights), "l.json");
  EXPECT_EQ(back.paths, lights.paths);
  EXPECT_EQ(back.reflectivity, lights.reflectivity);
  EXPECT_EQ(back.kind, lights.kind);
  EXPECT_EQ(back.path, lights.path);
  EXPECT_EQ(back.bounce, lights.bounce);
  EXPECT_EQ(back.cone, lights.cone);
  expect_same_bits(back.position, lights.position);
  expect_same_bits(back.normal, lights.normal);
  expect_same_bits(back.flux, lights.flux);
}

TEST(LightsJson, IsWhatTheFormatSays) {
  const Json file = Json::parse(to_json(lights_of_all_kinds(4)));
  ASSERT_EQ(file["lights"].size(), 4u);
  EXPECT_EQ(file["paths"], 123456789012);
  for (const char* key : {"position", "normal", "flux"}) {
    for (const Json& light : file["lights"]) EXPECT_EQ(light[key].size(), 3u);
  }
  EXPECT_FALSE(file["lights"][0].contains("kind"));
  EXPECT_EQ(file["lights"][1]["kind"], "point");
  EXPECT_EQ(file["lights"][2]["kind"], "spot");
  EXPECT_EQ(file["lights"][2]["cone"].size(), 2u);
  EXPECT_EQ(file["lights"][3]["kind"], "directional");
  EXPECT_EQ(lights_from_json(to_json(VirtualLights{}), "none").size(), 0u);
}

std::string message_of(const std::string& text) {
  try {
    lights_from_json(text, "lights.json");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

struct Fault {
  const char* message;
  std::function<void(Json&)> change;
};

const std::vector<Fault> kFaults = {
    {"has no array 'lights'", [](Json& f) { f.erase("lights"); }},
    {"has no array 'lights'", [](Json& f) { f["lights"] = 3; }},
    {"has no array 'lights'", [](Json& f) { f = Json::array(); }},
    {"'paths' or", [](Json& f) { f["paths"] = "many"; }},
    {"'paths' or", [](Json& f) { f["paths"] = -1; }},
    {"'paths' or", [](Json& f) { f.erase("paths"); }},
    {"'paths' or", [](Json& f) { f["reflectivity"] = nullptr; }},
    {"light 1: is no object", [](Json& f) { f["lights"][1] = 7; }},
    {"light 2: has no 'position'", [](Json& f) { f["lights"][2].erase("position"); }},
    {"light 0: has no 'normal'", [](Json& f) { f["lights"][0].erase("normal"); }},
    {"light 0: has no 'flux'", [](Json& f) { f["lights"][0].erase("flux"); }},
    {"light 0: has no 'path'", [](Json& f) { f["lights"][0].erase("path"); }},
    {"light 0: has no 'bounce'", [](Json& f) { f["lights"][0].erase("bounce"); }},
    {"light 2: has no 'cone'", [](Json& f) { f["lights"][2].erase("cone"); }},
    {"not three numbers",
     [](Json& f) {
       f["lights"][0]["flux"] = {1, 2};
     }},
    {"not three numbers", [](Json& f) { f["lights"][0]["flux"] = 1; }},
    {"not two numbers",
     [](Json& f) {
       f["lights"][2]["cone"] = {1, 2, 3};
     }},
    {"not finite", [](Json& f) { f["lights"][0]["position"][1] = nullptr; }},
    {"not finite", [](Json& f) { f["lights"][0]["position"][1] = "NaN"; }},
    {"not finite", [](Json& f) { f["lights"][0]["position"][1] = 1e39; }},
    {"'flux' is negative", [](Json& f) { f["lights"][0]["flux"][2] = -1e-9; }},
    {"not of unit length",
     [](Json& f) {
       f["lights"][0]["normal"] = {0, 0, 2};
     }},
    {"not of unit length",
     [](Json& f) {
       f["lights"][0]["normal"] = {0, 0, 0};
     }},
    {"'path' is no count", [](Json& f) { f["lights"][0]["path"] = -1; }},
    {"'path' is no count", [](Json& f) { f["lights"][0]["path"] = 4294967296; }},
    {"'bounce' is no count", [](Json& f) { f["lights"][0]["bounce"] = 1.5; }},
    {"'kind' is not", [](Json& f) { f["lights"][0]["kind"] = "area"; }},
    {"'kind' is not", [](Json& f) { f["lights"][0]["kind"] = 1; }},
};

TEST(LightsJson, NamesTheFaultInOneLine) {
  const Json sound = Json::parse(to_json(lights_of_all_kinds(4)));
  ASSERT_THAT(message_of(sound.dump()), IsEmpty());
  for (const Fault& fault : kFaults) {
    Json file = sound;
    fault.change(file);
    const std::string message = message_of(file.dump());
    EXPECT_THAT(message, HasSubstr(fault.message)) << file.dump();
    EXPECT_THAT(message, ::testing::StartsWith("lights.json"));
    EXPECT_THAT(message, ::testing::Not(HasSubstr("\n")));
  }
  EXPECT_THAT(message_of(""), HasSubstr("is not JSON"));
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\n"), HasSubstr("is not JSON"));
  EXPECT_THAT(message_of(R"({"paths": NaN, "lights": []})"), HasSubstr("is not JSON"));
  EXPECT_THAT(message_of(R"({"paths": 1, "reflectivity": 1e999, "lights": []})"),
              HasSubstr("out of range"));
  EXPECT_THAT(message_of("\xff\xfe\x00"), HasSubstr("is not JSON"));
}

TEST(LightsJson, RefusesWhatIsCutOff) {
  const std::string whole = to_json(lights_of_all_kinds(40));
  for (std::size_t size = 0; size + 2 < whole.size(); size += 64) {
    EXPECT_THAT(message_of(whole.substr(0, size)), HasSubstr("is not JSON")) << "byte " << size;
  }
}

TEST(LightsJson, RendersTheSamePicture) {
  Scene scene = test::box_room(Vec3(2.0f, 1.5f, 2.5f), 0.5f, 0.0f);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emission = Rgb(4.0f, 3.0f, 2.0f);
  scene.meshes[1].material = MaterialId{1};
  PunctualLight spot;
  spot.kind = PunctualKind::kSpot;
  spot.direction = glm::normalize(Vec3(0.3f, -1.0f, 0.2f));
  scene.lights = {PunctualLight{}, spot};
  scene.cameras.emplace_back().eye = Vec3(0.1f, 0.2f, 1.0f);
  for (const float bound : {0.0f, 5.0f}) {
    RenderOptions options;
    options.width = 24;
    options.height = 16;
    options.bound = bound;
    options.compensate = bound > 0.0f;
    options.lights.paths = 50;
    std::vector<std::string> warnings;
    const VirtualLights made = make_lights(scene, options.lights, warnings);
    const VirtualLights read = lights_from_json(to_json(made), "l.json");
    const Image image = render(scene, options, StopFlag{false}).image;
    options.given_lights = &read;
    const Image again = render(scene, options, StopFlag{false}).image;
    expect_same_bits(again.pixels, image.pixels);
    EXPECT_GT(max_component(image.at(12, 8)), 0.0f);
  }
}

TEST(LightsFiles, GoByTheirExtension) {
  const test::TemporaryFolder folder;
  const VirtualLights lights = lights_of_all_kinds(5);
  write_lights(folder / "l.json", lights);
  EXPECT_EQ(read_lights(folder / "l.json").size(), 5u);
  write_lights(folder / "l.ply", lights);
  write_lights(folder / "l.gltf", lights);
  EXPECT_TRUE(std::filesystem::exists(folder / "l.ply"));
  EXPECT_THROW(write_lights(folder / "l.txt", lights), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "l.txt"));
  EXPECT_THROW(read_lights(folder / "missing.json"), Error);
  EXPECT_THROW(read_lights(folder / "l.ply"), Error);
}

// --- lights as points
// --------------------------------------------------------------------------------------

TEST(LightsPly, HasARowOfItsPropertiesForEachLight) {
  const VirtualLights lights = lights_of_all_kinds(9);
  std::istringstream file(to_ply(lights));
  std::string line;
  std::vector<std::string> properties;
  std::size_t vertices = 0;
  std::getline(file, line);
  EXPECT_EQ(line, "ply");
  while (std::getline(file, line) && line != "end_header") {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "element") {
      EXPECT_EQ(second, "vertex");
      vertices = std::stoul(third);
    }
    if (first == "property") properties.push_back(third);
  }
  EXPECT_EQ(vertices, 9u);
  EXPECT_THAT(properties, ElementsAre("x", "y", "z", "nx", "ny", "nz", "flux_r", "flux_g", "flux_b",
                                      "path", "bounce", "red", "green", "blue"));
  std::size_t row = 0;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::vector<double> values;
    for (std::string word; words >> word;) values.push_back(std::stod(word));
    ASSERT_EQ(values.size(), properties.size());
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      EXPECT_EQ(static_cast<float>(values[i]), lights.position[row][c]);
      EXPECT_EQ(static_cast<float>(values[3 + i]), lights.normal[row][c]);
      EXPECT_EQ(static_cast<float>(values[6 + i]), lights.flux[row][c]);
      EXPECT_GE(values[11 + i], 0.0);
      EXPECT_LE(values[11 + i], 255.0);
    }
    EXPECT_EQ(values[9], lights.path[row]);
    EXPECT_EQ(values[10], lights.bounce[row]);
    ++row;
  }
  EXPECT_EQ(row, vertices);
}

// --- lights as glTF
// ---------------------------------------------------------------------------------------

TEST(LightsGltf, TurnsTheAxisToTheNormalAndTakesFluxOverPi) {
  VirtualLights lights = lights_of_all_kinds(40);
  lights.normal[4] = Vec3(0, 0, 1);   // opposite to glTF's axis
  lights.normal[8] = Vec3(0, 0, -1);  // the axis itself
  lights.normal[12] = glm::normalize(Vec3(1e-4f, 0, 1));
  const Json file = Json::parse(to_gltf(lights));
  EXPECT_EQ(file["asset"]["version"], "2.0");
  EXPECT_THAT(file["extensionsUsed"], ElementsAre("KHR_lights_punctual"));
  const Json& list = file["extensions"]["KHR_lights_punctual"]["lights"];
  ASSERT_EQ(list.size(), lights.size());
  ASSERT_EQ(file["nodes"].size(), lights.size());
  ASSERT_EQ(file["scenes"][0]["nodes"].size(), lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Json& node = file["nodes"][i];
    const Json& light = list[node["extensions"]["KHR_lights_punctual"]["light"].get<std::size_t>()];
    const auto q = node["rotation"].get<std::vector<float>>();
    const Quat rotation(q[3], q[0], q[1], q[2]);
    EXPECT_NEAR(glm::length(rotation), 1.0f, 1e-6f);
    // A quaternion near half a turn comes out of a difference of numbers near one.
    EXPECT_LT(glm::distance(rotation * Vec3(0, 0, -1), lights.normal[i]), 1e-3f) << "light " << i;
    const auto t = node["translation"].get<std::vector<float>>();
    EXPECT_EQ(Vec3(t[0], t[1], t[2]), lights.position[i]);

    const auto c = light["color"].get<std::vector<float>>();
    const float intensity = light["intensity"].get<float>();
    constexpr const char* kTypes[] = {"spot", "point", "spot", "directional"};
    EXPECT_EQ(light["type"], kTypes[i % 4]);
    const float solid_angle = i % 4 == 0   ? kPi
                              : i % 4 == 1 ? 4.0f * kPi
                              : i % 4 == 2 ? spot_solid_angle(lights.cone[i])
                                           : 1.0f;
    for (int channel = 0; channel < 3; ++channel) {
      const float value = c[static_cast<std::size_t>(channel)];
      EXPECT_GE(value, 0.0f);
      EXPECT_LE(value, 1.0f);  // as KHR_lights_punctual demands
      EXPECT_NEAR(intensity * value, lights.flux[i][channel] / solid_angle,
                  1e-6f * max_component(lights.flux[i]));
    }
    if (i % 4 == 0) {
      EXPECT_EQ(light["spot"]["innerConeAngle"].get<double>(), 0.0);
      // The limit of KHR_lights_punctual, which the float next to it exceeds.
      EXPECT_LE(light["spot"]["outerConeAngle"].get<double>(), 0.5 * std::numbers::pi);
      EXPECT_NEAR(light["spot"]["outerConeAngle"].get<double>(), 0.5 * std::numbers::pi, 1e-6);
    }
  }
}

TEST(LightsGltf, LoadsAsSpotLights) {
  const Scene room = test::box_room(Vec3(2.0f, 1.5f, 2.5f), 0.5f, 3.0f);
  LightOptions options;
  options.paths = 20;
  std::vector<std::string> warnings;
  const VirtualLights lights = make_lights(room, options, warnings);
  const test::TemporaryFolder folder;
  // A scene needs a triangle, so one is put beside the lights, as who uses the file would.
  Json file = Json::parse(to_gltf(lights));
  file["scenes"][0]["nodes"].push_back(file["nodes"].size());
  file["nodes"].push_back({{"mesh", 0}});
  file["meshes"] = Json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0}}]}])");
  file["accessors"] = Json::parse(R"([{"bufferView": 0, "componentType": 5126, "count": 3,
      "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}])");
  file["bufferViews"] = Json::parse(R"([{"buffer": 0, "byteLength": 36}])");
  file["buffers"] =
      Json::parse(R"([{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                  R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])");
  write_file(folder / "lights.gltf", file.dump());
  const Loaded loaded = load_scene(folder / "lights.gltf");
  ASSERT_EQ(loaded.scene.lights.size(), lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const PunctualLight& light = loaded.scene.lights[i];
    EXPECT_EQ(light.kind, PunctualKind::kSpot);
    EXPECT_LT(glm::distance(light.position, lights.position[i]), 1e-6f);
    EXPECT_LT(glm::distance(light.direction, lights.normal[i]), 1e-5f);
    EXPECT_NEAR(light.intensity.g, lights.flux[i].g / kPi, 1e-6f * lights.flux[i].g);
    EXPECT_NEAR(light.outer_angle, 0.5f * kPi, 1e-6f);
  }
}

}  // namespace
}  // namespace lantern
