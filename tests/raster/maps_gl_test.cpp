// SPDX-License-Identifier: MIT
// Shadow maps against shadow rays, light by light, from the very points that GL drew; what they
// cannot see; and that kept maps are as good as new ones.
#include "lantern/core/hash.h"
#include "lantern/gl/context.h"
#include "lantern/raster/lighting.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/surfaces.h"

#include "tests/gl/apis.h"
#include "tests/raster/raster_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace lantern {
namespace {

constexpr int kWidth = 64, kHeight = 64;

/// What shadow rays say of what maps say, of all lights.
struct Difference {
  std::size_t compared = 0;  // could be lit
  std::size_t lit = 0;
  std::size_t leaks = 0;  // lit by maps alone
  std::size_t lost = 0;   // lit by rays alone
  double share(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(compared);
  }
};

struct Maps {
  const test::RasterStage& stage;
  gl::ShaderFiles files;
  Surfaces surfaces;
  ShadowMaps maps;
  StageTimes times;
  Lighting by_maps, unshadowed;

  explicit Maps(const test::RasterStage& with, const ShadowMapOptions& options = {})
      : stage(with),
        surfaces(with.scene, with.world, files),
        maps(with.scene, with.world, surfaces, files, options),
        by_maps(surfaces, {.volumes = nullptr, .maps = {&maps}}, times, files, kWidth, kHeight),
        unshadowed(surfaces, {}, times, files, kWidth, kHeight) {}

  std::vector<LightGroup> groups(const VirtualLights& lights) const {
    return group_lights(lights, {}, stage.world.coordinate_scale());
  }

  /// Green of every pixel.
  std::vector<float> irradiance(Lighting& lighting, const Camera& camera,
                                std::span<const LightGroup> lights) const {
    const View view = make_view(camera, {.width = kWidth,
                                         .height = kHeight,
                                         .offset = Vec2(0.3f, 0.6f),
                                         .radius = stage.world.bounds.radius()});
    lighting.draw(view, lights, [] { return true; });
    std::vector<float> green;
    const QuadLayout quads{MaskedShading::kTile, kWidth, kHeight};
    for (const Rgb& e : lighting.shading().irradiance().read(quads)) {
      green.push_back(e.g);
    }
    return green;
  }

  Difference compare(const Camera& camera, const VirtualLights& lights) {
    Difference difference;
    for (const LightGroup& all : groups(lights)) {
      for (std::size_t i = 0; i < all.records.size(); ++i) {
        compare_one(camera, {all.formula, {all.records[i]}, {all.points[i]}}, difference);
      }
    }
    return difference;
  }

  void compare_one(const Camera& camera, const LightGroup& light, Difference& difference) {
    const std::span<const LightGroup> lights(&light, 1);
    const std::vector<float> seen = irradiance(by_maps, camera, lights);
    const std::vector<float> all = irradiance(unshadowed, camera, lights);
    const auto points = unshadowed.g_buffer().framebuffer.read<std::uint32_t>(0);
    for (std::size_t pixel = 0; pixel < all.size(); ++pixel) {
      if (all[pixel] == 0.0f) continue;
      const auto word = [&](std::size_t i) { return std::bit_cast<float>(points[4 * pixel + i]); };
      const LightPoint& point = light.points[0];
      Ray ray;
      ray.origin = Vec3(word(0), word(1), word(2));
      ray.direction = Vec3(point) - point.w * ray.origin;
      ray.far = point.w != 0.0f ? 1.0f : kInfinity;
      const bool lit = !stage.tracer->occluded(ray);
      const bool by_map = seen[pixel] > 0.0f;
      ++difference.compared;
      difference.lit += lit ? 1 : 0;
      difference.leaks += by_map && !lit ? 1 : 0;
      difference.lost += lit && !by_map ? 1 : 0;
    }
  }
};

class MapsTest : public ::testing::TestWithParam<gl::Api> {
 protected:
  gl::Context context_{{.api = GetParam(), .device = {}}};
};
INSTANTIATE_TEST_SUITE_P(Apis, MapsTest, ::testing::Values(gl::Api::kDesktop, gl::Api::kEs));

Difference compare(const test::RasterStage& stage, std::size_t paths, int cameras,
                   const ShadowMapOptions& options = {}) {
  Maps maps(stage, options);
  Difference all;
  for (const Camera& camera : test::random_cameras(stage.world.bounds, cameras)) {
    const Difference d = maps.compare(camera, stage.lights(paths));
    all.compared += d.compared;
    all.lit += d.lit;
    all.leaks += d.leaks;
    all.lost += d.lost;
  }
  EXPECT_GT(all.lit, all.compared / 10);
  EXPECT_LT(all.lit, all.compared);
  return all;
}

/// Rasterisers move corners to a grid of 1/256 of a texel, and packed normals turn by a hair.
constexpr double kRounding = 0.0005;

TEST_P(MapsTest, CornellBox) {
  const Difference d = compare(test::RasterStage(test::own_scene("cornell_box.scene")), 12, 3);
  EXPECT_LT(d.share(d.leaks), kRounding);
  EXPECT_LT(d.share(d.lost), kRounding);
}

TEST_P(MapsTest, TwoRooms) {
  const Difference d = compare(test::RasterStage(test::own_scene("two_rooms.scene")), 12, 3);
  EXPECT_LT(d.share(d.leaks), kRounding);
  EXPECT_LT(d.share(d.lost), kRounding);
}

TEST_P(MapsTest, Balls) {
  const Difference d = compare(test::RasterStage(test::room_of_balls(16, 16)), 4, 2);
  EXPECT_LT(d.share(d.leaks), kRounding);
  EXPECT_LT(d.share(d.lost), kRounding);
}

TEST_P(MapsTest, BallsInMapsOfFewTriangles) {
  const test::RasterStage stage(test::room_of_balls(16, 16));
  const Difference d = compare(stage, 4, 2, {.size = 256});
  EXPECT_LT(d.share(d.leaks), kRounding);
  EXPECT_LT(d.share(d.lost), kRounding);
}

/// A grating of bars 12 mm wide where texels are three or four times as wide: without their edges a
/// third of its shadow is missed, 1.1 %.
TEST_P(MapsTest, BarsThatAreMoreSlenderThanTexels) {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(2);
  const Mesh bar = scene.meshes[0];  // a closed box, as the room is
  const auto number = to_id<MeshId>(static_cast<std::uint32_t>(scene.meshes.size()));
  scene.meshes.push_back(bar);
  for (int i = 0; i < 20; ++i) {
    const Vec3 place(0.2f + 0.18f * static_cast<float>(i), 1.5f, 0.5f);
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = number;
    instance.transform = glm::scale(glm::translate(Mat4(1.0f), place), Vec3(0.003f, 0.003f, 0.75f));
  }
  const Difference d = compare(test::RasterStage(std::move(scene)), 6, 3);
  EXPECT_LT(d.share(d.leaks), 0.001);
  EXPECT_LT(d.share(d.lost), kRounding);
}

/// Leaves of 2 cm that share no edges, about as large as texels: which of them are seen is up to
/// chance, but as much light gets through as by rays, 85 %.
TEST_P(MapsTest, LeavesThatAreSmallerThanTexels) {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(2);
  Mesh leaves;
  constexpr std::uint32_t kLeaves = 50'000;
  for (std::uint32_t i = 0; i < kLeaves; ++i) {
    const auto number = [&](std::uint64_t k) { return to_unit_float(hash(i, k)); };
    const Vec3 place(4.0f * number(0), 0.8f + 0.3f * number(1), 4.0f * number(2));
    const Vec3 u = glm::normalize(Vec3(number(3), number(4), number(5)) - 0.5f);
    const Vec3 v = glm::normalize(glm::cross(u, Vec3(number(6), number(7), number(8)) - 0.5f));
    for (const Vec3& corner : {place, place + 0.02f * u, place + 0.02f * v}) {
      leaves.positions.push_back(corner);
    }
    leaves.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  scene.instances.push_back(
      {.mesh = to_id<MeshId>(scene.meshes.size()), .transform = Mat4(1.0f), .material = {}});
  scene.meshes.push_back(leaves);
  const Difference d = compare(test::RasterStage(std::move(scene)), 6, 2);
  // 2.9 % leak and 2.6 % are lost; were all rays that meet no leaf they know of lit, 3.6 and 0.4 %.
  EXPECT_NEAR(d.share(d.leaks), d.share(d.lost), 0.02);
}

TEST_P(MapsTest, LightsOfOtherKinds) {
  Scene scene = test::room_of_balls(12, 12);
  scene.meshes[0].triangles.resize(10);  // for the sun to shine in
  scene.materials[2].emission = Rgb(0.0f);
  PunctualLight point, spot, sun;
  point.position = Vec3(3.1f, 2.0f, 3.0f);
  spot.kind = PunctualKind::kSpot;
  spot.position = Vec3(3.5f, 3.5f, 3.5f);
  spot.direction = glm::normalize(Vec3(-0.8f, -1.0f, -0.9f));
  sun.kind = PunctualKind::kDirectional;
  sun.direction = glm::normalize(Vec3(0.2f, -1.0f, -0.3f));
  scene.lights = {point, spot, sun};
  const Difference d = compare(test::RasterStage(std::move(scene)), 6, 2);
  EXPECT_LT(d.share(d.leaks), kRounding);
  EXPECT_LT(d.share(d.lost), kRounding);
}

/// Far sides of closed bodies are left out of maps, but not those around a light. Fronts or backs
/// are outside.
TEST_P(MapsTest, LightsInsideAndOutsideOfBalls) {
  for (const bool inside_out : {false, true}) {
    Scene scene = test::room_of_balls(12, 12);
    scene.materials[2].emission = Rgb(0.0f);
    if (inside_out) {
      for (uvec3& triangle : scene.meshes[2].triangles) std::swap(triangle.y, triangle.z);
    }
    PunctualLight inside, outside;
    inside.position = Vec3(1.52f, 1.47f, 1.55f);
    outside.position = Vec3(2.05f, 2.0f, 1.9f);
    scene.lights = {inside, outside};
    const Difference d = compare(test::RasterStage(std::move(scene)), 2, 3);
    EXPECT_LT(d.share(d.leaks), kRounding);
    EXPECT_LT(d.share(d.lost), kRounding);
  }
}

/// A wall without thickness, from which all light stays away: depths compared with a bias would
/// leak along its foot. (Under the ceiling the lamp would leave a light a slit to see it through.)
TEST_P(MapsTest, NothingComesThroughAWall) {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(2);
  Mesh wall;
  wall.positions = {{2.0f, 0.0f, 0.0f}, {2.0f, 4.0f, 0.0f}, {2.0f, 4.0f, 4.0f}, {2.0f, 0.0f, 4.0f}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(wall);
  scene.instances.push_back({.mesh = to_id<MeshId>(3), .transform = Mat4(1.0f), .material = {}});
  scene.instances[1].transform =
      glm::translate(Mat4(1.0f), Vec3(-0.9f, -0.9f, 0.0f));  // the lamp, to the wall's other side
  scene.meshes[1].positions[1].x = scene.meshes[1].positions[2].x = 2.4f;
  const test::RasterStage stage(std::move(scene));
  Maps maps(stage);
  Camera camera;
  camera.eye = Vec3(3.9f, 2.0f, 2.0f);
  camera.forward = Vec3(-1.0f, 0.0f, 0.0f);
  camera.vertical_fov = 1.9f;
  const std::vector<LightGroup> groups = maps.groups(stage.lights(40));
  const auto lit = [&](Lighting& lighting) {
    const std::vector<float> irradiance = maps.irradiance(lighting, camera, groups);
    return std::count_if(irradiance.begin(), irradiance.end(), [](float e) { return e > 0.0f; });
  };
  EXPECT_GT(lit(maps.unshadowed), kWidth * kHeight / 3);
  EXPECT_EQ(lit(maps.by_maps), 0);
}

TEST_P(MapsTest, KeptMapsAreAsGoodAsNewOnes) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  Maps kept(stage), fresh(stage, {.bytes = 0});
  const std::vector<LightGroup> groups = kept.groups(stage.lights(40));
  ASSERT_GT(groups.size(), 1u);
  std::size_t lights = 0;
  for (const LightGroup& group : groups) lights += group.records.size();
  for (std::size_t view = 1; view <= 3; ++view) {
    const Camera camera = test::random_cameras(stage.world.bounds, 3)[view - 1];
    kept.maps.keep(groups);
    EXPECT_EQ(kept.irradiance(kept.by_maps, camera, groups),
              fresh.irradiance(fresh.by_maps, camera, groups));
    EXPECT_EQ(kept.maps.drawn(), lights);
    EXPECT_EQ(fresh.maps.drawn(), view * lights);
  }
  // Other lights are drawn anew, and those that are not asked for are forgotten.
  kept.maps.keep({});
  kept.irradiance(kept.by_maps, stage.scene.cameras[0], groups);
  EXPECT_EQ(kept.maps.drawn(), 2 * lights);
}

TEST_P(MapsTest, WhereMemoryEndsSomeAreKept) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  constexpr int kSize = 128;
  // Of 32 lights.
  constexpr std::size_t kOneGroup = 32 * (kSize * 3 / 4) * (kSize * 3 / 4) * kMapTexelBytes;
  Maps maps(stage, {.size = kSize, .bytes = 2 * kOneGroup});
  std::vector<LightGroup> groups = maps.groups(stage.lights(80));
  groups.resize(4);
  for (int view = 0; view < 3; ++view) {
    maps.irradiance(maps.by_maps, stage.scene.cameras[0], groups);
  }
  // One group stays, the other room goes to the rest in turn.
  EXPECT_GE(maps.maps.drawn(), kLightsInGroup * 4);
  EXPECT_LE(maps.maps.drawn(), kLightsInGroup * (4 + 3 + 3));
}

}  // namespace
}  // namespace lantern
