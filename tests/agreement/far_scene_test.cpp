// SPDX-License-Identifier: MIT
// A scene far from zero looks like the same scene at zero.
#include "lantern/core/file.h"
#include "lantern/lights/export.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/edits.h"
#include "lantern/pipeline/render_instant_radiosity.h"

#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

namespace lantern {
namespace {

/// A room around zero, open to +z, with a lamp below its ceiling; every coordinate moved by `far`.
Loaded room(const test::TemporaryFolder& folder, double far) {
  std::string obj;
  const auto quad = [&](const char* material, std::initializer_list<glm::dvec3> corners) {
    for (const glm::dvec3& c : corners) {
      obj += fmt::format("v {} {} {}\n", c.x + far, c.y + far, c.z + far);
    }
    obj += fmt::format("usemtl {}\nf -4 -3 -2 -1\n", material);
  };
  quad("wall", {{-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}});
  quad("wall", {{-2, 2, 2}, {-2, 2, -2}, {2, 2, -2}, {2, 2, 2}});
  quad("wall", {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}});
  quad("wall", {{-2, -2, 2}, {-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}});
  quad("wall", {{2, -2, 2}, {2, 2, 2}, {2, 2, -2}, {2, -2, -2}});
  quad("lamp", {{-0.5, 1.75, -0.5}, {0.5, 1.75, -0.5}, {0.5, 1.75, 0.5}, {-0.5, 1.75, 0.5}});
  write_file(folder / "room.obj", obj);
  Loaded loaded = load_scene(folder / "room.obj");
  apply(EmitterEdit{"lamp", Rgb(9.0f)}, loaded.scene);
  return loaded;
}

Image picture(const Scene& scene, float far, const VirtualLights* lights = nullptr) {
  RenderOptions options;
  options.width = options.height = 48;
  options.lights.paths = 32;
  options.bound = 5.0f;
  options.compensate = true;
  options.camera.eye = Vec3(far, far, far + 8.0f);
  options.camera.target = Vec3(far);
  options.given_lights = lights;
  const StopFlag never{false};
  return render(scene, options, never).image;
}

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

// The room's coordinates are multiples of 2^-2, which floats hold up to 2^21: nothing is lost on
// the way, and so not a bit of the picture may change.
constexpr float kFar = 0x1p20f;

TEST(FarScene, HasThePictureOfTheSameSceneAtZero) {
  const test::TemporaryFolder folder;
  const Loaded near = room(folder, 0.0);
  const Loaded far = room(folder, static_cast<double>(kFar));
  EXPECT_EQ(near.scene.origin, Vec3(0.0f));
  EXPECT_EQ(far.scene.origin, Vec3(kFar));
  EXPECT_TRUE(same_bits(picture(far.scene, kFar), picture(near.scene, 0.0f)));
}

TEST(FarScene, WritesItsLightsInItsOwnCoordinatesAndReadsThemBack) {
  const test::TemporaryFolder folder;
  const Scene scene = room(folder, static_cast<double>(kFar)).scene;
  std::vector<std::string> warnings;
  LightOptions options;
  options.paths = 32;
  const VirtualLights lights = make_lights(scene, options, warnings);
  write_lights(folder / "l.json", lights, scene.origin);
  const VirtualLights as_written = read_lights(folder / "l.json");
  const VirtualLights back = read_lights(folder / "l.json", scene.origin);
  ASSERT_EQ(back.size(), lights.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back.position[i], lights.position[i]);
    EXPECT_NEAR(as_written.position[i].y, kFar, 3.0f);
  }
  EXPECT_TRUE(same_bits(picture(scene, kFar, &back), picture(scene, kFar)));
}

}  // namespace
}  // namespace lantern
