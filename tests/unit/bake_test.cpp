// SPDX-License-Identifier: MIT
// Baking: charts lie apart and keep their shape, the lightmap holds the light of the surface up to
// and over its edges, and the file is laid out as the format wants.
#include "lantern/bake/bake.h"

#include "lantern/bake/atlas.h"
#include "lantern/bake/glb.h"
#include "lantern/bake/lightmap.h"
#include "lantern/core/error.h"
#include "lantern/trace/embree.h"

#include "tests/analytic/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <set>

namespace lantern {
namespace {

using test::add_material;
using test::add_quad;
using test::box_room;

/// Coordinates in texels are floats of up to some hundred.
constexpr float kTexelRounding = 1e-3f;

struct Prepared {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;
  Patches patches;

  Prepared(Scene given, std::size_t count)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)),
        patches(fronts(count)) {}
  /// Of all fronts, whatever lights them: the tests give irradiances of their own.
  Patches fronts(std::size_t count) const {
    PatchMesh mesh = make_patch_mesh(world);
    refine_to_count(mesh, count);
    const std::vector<bool> all(world.size(), true), none(world.size(), false);
    return make_patches(scene, world, *tracer, std::move(mesh), {.front = all, .back = none});
  }
  Atlas atlas(int size) const { return make_atlas(world, patches, size); }
  Solution solution(const std::function<double(const glm::dvec3&)>& irradiance) const {
    std::vector<glm::dvec3> values;
    for (std::uint32_t e = 0; e < patches.elements(); ++e) {
      values.emplace_back(irradiance(patches.centre[patches.patch[e]]));
    }
    return {scene, world, patches, values};
  }
};

Scene one_quad(const Vec3& corner = Vec3(1.0f, 2.0f, 3.0f),
               const Vec3& along = Vec3(4.0f, 0.0f, 3.0f),
               const Vec3& up = Vec3(0.0f, 2.0f, 0.0f)) {
  Scene scene;
  add_quad(scene, add_material(scene, 0.5f, 0.0f), corner, along, up);
  return scene;
}

/// What must hold for any atlas.
void expect_sound(const Prepared& prepared, const Atlas& atlas) {
  std::vector<int> taken(static_cast<std::size_t>(atlas.size * atlas.size), 0);
  std::size_t elements = 0;
  for (const Chart& chart : atlas.charts) {
    ASSERT_GE(chart.x, 0);
    ASSERT_GE(chart.y, 0);
    ASSERT_LE(chart.x + chart.width, atlas.size);
    ASSERT_LE(chart.y + chart.height, atlas.size);
    for (int y = chart.y; y < chart.y + chart.height; ++y) {
      for (int x = chart.x; x < chart.x + chart.width; ++x) {
        ASSERT_EQ(taken[static_cast<std::size_t>(y * atlas.size + x)]++, 0) << "charts overlap";
      }
    }
    elements += chart.elements.size();
  }
  EXPECT_EQ(elements, prepared.patches.elements());
  for (std::uint32_t e = 0; e < prepared.patches.elements(); ++e) {
    const Chart& chart = atlas.charts[atlas.chart[e]];
    for (int k = 0; k < 3; ++k) {
      const Vec2 at = atlas.corners[e][static_cast<std::size_t>(k)];
      // A bilinear filter takes from half a texel away; the border is more.
      EXPECT_GE(at.x, static_cast<float>(chart.x + kChartBorder) + 0.5f - kTexelRounding);
      EXPECT_GE(at.y, static_cast<float>(chart.y + kChartBorder) + 0.5f - kTexelRounding);
      EXPECT_LE(at.x,
                static_cast<float>(chart.x + chart.width - kChartBorder) - 0.5f + kTexelRounding);
      EXPECT_LE(at.y,
                static_cast<float>(chart.y + chart.height - kChartBorder) - 0.5f + kTexelRounding);
      // Lengths are those of the surface, everywhere at the same scale.
      const Vec2 next = atlas.corners[e][static_cast<std::size_t>((k + 1) % 3)];
      const std::uint32_t patch = prepared.patches.patch[e];
      const double length = glm::length(prepared.patches.mesh.corner(patch, (k + 1) % 3) -
                                        prepared.patches.mesh.corner(patch, k));
      // Parts of a chart may lean by a degree.
      const double texels = length * atlas.texels_per_metre;
      EXPECT_NEAR(glm::length(next - at), texels, kTexelRounding + 1.5e-4 * texels);
    }
  }
}

TEST(Atlas, AFlatSurfaceIsOneChart) {
  const Prepared quad(one_quad(), 200);
  const Atlas atlas = quad.atlas(64);
  ASSERT_EQ(atlas.charts.size(), 1u);
  expect_sound(quad, atlas);
  // 5 m by 2 m lie along the texels: 59 of them leave room for the borders.
  EXPECT_NEAR(atlas.texels_per_metre, 59.0 / 5.0, 1e-4);
  EXPECT_EQ(atlas.charts[0].width, 64);
}

TEST(Atlas, EachWallOfARoomIsOne) {
  const Prepared room(box_room(Vec3(4.0f, 3.0f, 5.0f), 0.5f, 1.0f), 300);
  const Atlas atlas = room.atlas(128);
  EXPECT_EQ(atlas.charts.size(), 6u);
  expect_sound(room, atlas);
}

TEST(Atlas, MaterialsLieApart) {
  Scene scene = one_quad(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f));
  add_quad(scene, add_material(scene, 0.2f, 0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(1.0f, 0.0f, 0.0f),
           Vec3(0.0f, 1.0f, 0.0f));
  const Prepared two(std::move(scene), 64);
  const Atlas atlas = two.atlas(64);
  EXPECT_EQ(atlas.charts.size(), 2u);
  expect_sound(two, atlas);
}

TEST(Atlas, HoldsManySmallCharts) {
  const Prepared sphere(test::sphere_room(3, 0.5f, 1.0f), 1);
  expect_sound(sphere, sphere.atlas(256));
}

TEST(Atlas, NamesTheSizeItNeeds) {
  const Prepared room(box_room(Vec3(4.0f, 3.0f, 5.0f), 0.5f, 1.0f), 12);
  try {
    room.atlas(8);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("it takes 16x16 at least"));
  }
  expect_sound(room, room.atlas(16));
}

// ---- The lightmap ----

// Irradiance that is linear over the surface is linear between its vertices, so every texel knows
// its own: here E = 1 + 0.1 y, y the height above the lower edge, and the radiance 0.5 E / pi.
TEST(Lightmap, HoldsTheLightOfTheSurface) {
  const Prepared quad(one_quad(), 500);
  const Atlas atlas = quad.atlas(64);
  const Lightmap map =
      make_lightmap(quad.solution([](const glm::dvec3& p) { return 1.0 + 0.1 * p.y; }), atlas);
  const Chart& chart = atlas.charts[0];
  // Texel rows of the lower edge and of the upper one, whichever way the chart was turned.
  const auto place_of = [&](double height) {
    for (std::uint32_t e = 0; e < quad.patches.elements(); ++e) {
      for (int k = 0; k < 3; ++k) {
        if (std::abs(quad.patches.mesh.corner(quad.patches.patch[e], k).y - height) < 1e-6) {
          return atlas.corners[e][static_cast<std::size_t>(k)].y;
        }
      }
    }
    return -1.0f;
  };
  const float low = place_of(2.0), high = place_of(4.0);
  for (int y = chart.y; y < chart.y + chart.height; ++y) {
    const float share = std::clamp((static_cast<float>(y) + 0.5f - low) / (high - low), 0.0f, 1.0f);
    const float expected = 0.5f * (1.0f + 0.1f * (2.0f + 2.0f * share)) * kInvPi;
    for (int x = chart.x; x < chart.x + chart.width; ++x) {
      // Planes fitted to linear values are exact to the rounding of texel coordinates.
      EXPECT_NEAR(map.radiance.at(x, y).g, expected, 1e-4f * expected) << x << " " << y;
    }
  }
}

TEST(Lightmap, IsFilledUpToTheBorders) {
  const Prepared room(box_room(Vec3(4.0f, 3.0f, 5.0f), 0.5f, 0.0f), 300);
  for (const int size : {16, 17, 64, 256}) {
    const Atlas atlas = room.atlas(size);
    const Lightmap map = make_lightmap(room.solution([](const glm::dvec3&) { return 2.0; }), atlas);
    for (const Chart& chart : atlas.charts) {
      for (int y = chart.y; y < chart.y + chart.height; ++y) {
        for (int x = chart.x; x < chart.x + chart.width; ++x) {
          EXPECT_NEAR(map.radiance.at(x, y).r, 0.5f * 2.0f * kInvPi, 1e-6f) << size;
        }
      }
    }
  }
}

// ---- The file ----

std::uint32_t number(std::span<const std::byte> file, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

struct Parts {
  nlohmann::json json;
  std::span<const std::byte> buffer;
};

/// Checks the frame: magic, version, lengths and alignment.
Parts take_apart(std::span<const std::byte> file) {
  EXPECT_EQ(std::memcmp(file.data(), "glTF", 4), 0);
  EXPECT_EQ(number(file, 4), 2u);
  EXPECT_EQ(number(file, 8), file.size());
  const std::uint32_t text = number(file, 12);
  EXPECT_EQ(std::memcmp(file.data() + 16, "JSON", 4), 0);
  EXPECT_EQ(text % 4, 0u);
  const std::size_t second = 20 + text;
  const std::uint32_t bytes = number(file, second);
  EXPECT_EQ(std::memcmp(file.data() + second + 4, "BIN\0", 4), 0);
  EXPECT_EQ(bytes % 4, 0u);
  EXPECT_EQ(second + 8 + bytes, file.size());
  const auto* from = reinterpret_cast<const char*>(file.data()) + 20;
  return {nlohmann::json::parse(from, from + text), file.subspan(second + 8, bytes)};
}

void expect_sound(const Parts& parts) {
  const nlohmann::json& json = parts.json;
  EXPECT_EQ(json["buffers"][0]["byteLength"], parts.buffer.size());
  std::size_t end = 0;
  for (const auto& view : json["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_GE(view["byteOffset"], end) << "views overlap";
    end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
    EXPECT_LE(end, parts.buffer.size());
  }
  const std::map<std::string, std::size_t> components = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
  for (const auto& accessor : json["accessors"]) {
    const std::size_t bytes =
        4 * accessor["count"].get<std::size_t>() * components.at(accessor["type"]);
    EXPECT_EQ(json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteLength"], bytes);
  }
  for (const auto& mesh : json.value("meshes", nlohmann::json::array())) {
    for (const auto& primitive : mesh["primitives"]) {
      const auto& accessors = json["accessors"];
      const auto& positions = accessors[primitive["attributes"]["POSITION"].get<std::size_t>()];
      EXPECT_TRUE(positions.contains("min") && positions.contains("max"));
      for (const auto& [name, accessor] : primitive["attributes"].items()) {
        EXPECT_EQ(accessors[accessor.get<std::size_t>()]["count"], positions["count"]) << name;
      }
      const auto& indices = accessors[primitive["indices"].get<std::size_t>()];
      EXPECT_EQ(indices["count"].get<std::size_t>() % 3, 0u);
      const std::size_t at =
          json["bufferViews"][indices["bufferView"].get<std::size_t>()]["byteOffset"];
      for (std::size_t i = 0; i < indices["count"].get<std::size_t>(); ++i) {
        EXPECT_LT(number(parts.buffer, at + 4 * i), positions["count"]);
      }
    }
  }
}

TEST(Glb, LaysOutItsArrays) {
  Glb glb;
  EXPECT_EQ(glb.add(std::vector{Vec3(1, -2, 3), Vec3(0, 5, -6)}, true), 0u);
  EXPECT_EQ(glb.add_indices(std::vector{0u, 1u, 0u}), 1u);
  EXPECT_EQ(glb.add_png(std::vector(5, std::byte{7})), 0u);  // pads what follows
  EXPECT_EQ(glb.add(std::vector{Vec2(8, 9)}), 2u);
  const std::vector<std::byte> file = glb.bytes();
  const Parts parts = take_apart(file);
  expect_sound(parts);
  EXPECT_EQ(parts.json["asset"]["version"], "2.0");
  EXPECT_EQ(parts.json["accessors"][0]["min"], nlohmann::json({0.0, -2.0, -6.0}));
  EXPECT_EQ(parts.json["accessors"][0]["max"], nlohmann::json({1.0, 5.0, 3.0}));
  const std::size_t last = parts.json["bufferViews"][3]["byteOffset"];
  float value = 0.0f;
  std::memcpy(&value, parts.buffer.data() + last + 4, sizeof value);
  EXPECT_EQ(value, 9.0f);
}

TEST(Bake, HoldsBothInScenesOfTheirOwn) {
  const Prepared room(box_room(Vec3(4.0f, 3.0f, 5.0f), 0.5f, 0.0f), 60);
  const Solution solution = room.solution([](const glm::dvec3& p) { return 1.0 + 0.1 * p.y; });
  const Atlas atlas = room.atlas(64);
  for (const auto& [coloured_scene, mapped_scene] :
       {std::pair(true, true), {true, false}, {false, true}}) {
    BakeOptions options;
    options.vertex_colours = coloured_scene;
    const Baked baked = bake(solution, room.world, mapped_scene ? &atlas : nullptr, options);
    const Parts parts = take_apart(baked.file);
    expect_sound(parts);
    std::set<std::string> scenes;
    for (const auto& scene : parts.json["scenes"]) {
      const auto& mesh =
          parts.json["meshes"][parts.json["nodes"][scene["nodes"][0].get<std::size_t>()]["mesh"]
                                   .get<std::size_t>()];
      const bool coloured = mesh["primitives"][0]["attributes"].contains("COLOR_0");
      EXPECT_EQ(coloured, scene["name"] == "vertex colours");
      scenes.insert(scene["name"]);
      for (const auto& primitive : mesh["primitives"]) {
        const auto& material = parts.json["materials"][primitive["material"].get<std::size_t>()];
        EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
        const auto& surface = material["pbrMetallicRoughness"];
        EXPECT_EQ(surface.contains("baseColorTexture"), !coloured);
      }
    }
    EXPECT_EQ(scenes.contains("vertex colours"), coloured_scene);
    EXPECT_EQ(scenes.contains("lightmap"), mapped_scene);
    EXPECT_EQ(parts.json["scene"], 0);
    EXPECT_FLOAT_EQ(parts.json["asset"]["extras"]["radiance_of_white"], baked.radiance_of_white);
  }
}

// The room's irradiance is largest at the ceiling, y = 1.5: radiance 0.5 * 1.15 / pi.
TEST(Bake, TheBrightestReflectionIsJustWhite) {
  const Prepared room(box_room(Vec3(4.0f, 3.0f, 5.0f), 0.5f, 0.0f), 600);
  const Solution solution = room.solution([](const glm::dvec3& p) { return 1.0 + 0.1 * p.y; });
  BakeOptions options;
  // Planes fitted to linear values meet them at the vertices.
  EXPECT_NEAR(bake(solution, room.world, nullptr, options).radiance_of_white, 0.5f * 1.15f * kInvPi,
              1e-5f);
  options.exposure = 2.0f;
  EXPECT_NEAR(bake(solution, room.world, nullptr, options).radiance_of_white,
              0.125f * 1.15f * kInvPi, 1e-5f);
}

}  // namespace
}  // namespace lantern
