// SPDX-License-Identifier: MIT
// What lights matter to a picture.
#include "lantern/gather/importance.h"

#include "lantern/core/parallel.h"
#include "lantern/lights/resample.h"
#include "lantern/lights/walk.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lantern {
namespace {

using test::Stage;

constexpr Vec3 kBoxSize(2.0f, 2.0f, 2.0f);

/// From the middle of a room around the origin, along -z.
Camera camera_inside() {
  Camera camera;
  camera.eye = Vec3(0.0f);
  camera.forward = Vec3(0, 0, -1);
  camera.up = Vec3(0, 1, 0);
  camera.vertical_fov = 1.0f;
  return camera;
}

GatherOptions options_of(int width, int height) {
  GatherOptions options;
  options.width = width;
  options.height = height;
  return options;
}

void add_light(VirtualLights& lights, LightKind kind, const Vec3& position, const Vec3& normal,
               const Rgb& flux) {
  lights.kind.push_back(kind);
  lights.position.push_back(position);
  lights.normal.push_back(normal);
  lights.flux.push_back(flux);
  lights.path.push_back(static_cast<std::uint32_t>(lights.path.size()));
  lights.bounce.push_back(0);
  lights.cone.emplace_back(0.0f);
}

TEST(Importance, IsNoneForLightsThatThePictureDoesNotSee) {
  const Stage stage(test::box_room(kBoxSize, 0.5f, 0.0f));
  const Camera camera = camera_inside();
  VirtualLights pool;
  add_light(pool, LightKind::kPoint, Vec3(0.3f, 0.2f, -0.1f), Vec3(0, 0, 1), Rgb(1.0f));
  // Outside of the closed room, turned away from it, from infinity, and black.
  add_light(pool, LightKind::kPoint, Vec3(0.0f, 5.0f, 0.0f), Vec3(0, 0, 1), Rgb(1000.0f));
  add_light(pool, LightKind::kSurface, Vec3(0.0f, 0.0f, -1.0f), Vec3(0, 0, -1), Rgb(1000.0f));
  add_light(pool, LightKind::kDirectional, Vec3(0.0f), Vec3(0, -1, 0), Rgb(1000.0f));
  add_light(pool, LightKind::kPoint, Vec3(0.1f), Vec3(0, 0, 1), Rgb(0.0f));
  const std::vector<double> weights = importance(
      {stage.scene, stage.world, *stage.tracer, stage.emitters, camera}, pool, options_of(64, 64));
  ASSERT_EQ(weights.size(), pool.size());
  EXPECT_GT(weights[0], 0.0);
  for (std::size_t i = 1; i < pool.size(); ++i) EXPECT_EQ(weights[i], 0.0) << "light " << i;
}

TEST(Importance, IsASharePerPointSoThatLikeLightsShareAlike) {
  // Two lights in one place, one three times as bright: a quarter and three quarters of each point.
  // A third shines in another channel, where it is all there is.
  const Stage stage(test::box_room(kBoxSize, 0.5f, 0.0f));
  const Camera camera = camera_inside();
  VirtualLights pool;
  for (const Rgb& flux : {Rgb(1, 0, 0), Rgb(3, 0, 0), Rgb(0, 0.1f, 0)}) {
    add_light(pool, LightKind::kPoint, Vec3(0.1f, 0.2f, 0.3f), Vec3(0, 0, 1), flux);
  }
  const std::vector<double> weights = importance(
      {stage.scene, stage.world, *stage.tracer, stage.emitters, camera}, pool, options_of(64, 64));
  EXPECT_NEAR(weights[1] / weights[0], 3.0, 1e-5);
  // All points are lit, so their shares would add up to their number, but for the lift of dark
  // ones by a hundredth of the mean of the channels.
  EXPECT_LT(weights[0] + weights[1], 16.0);
  EXPECT_GT(weights[0] + weights[1], 15.0);
  EXPECT_LT(weights[2], weights[0] + weights[1]);
  EXPECT_GT(weights[2], 10.0);
}

TEST(Importance, IsZeroWhereNothingIsSeen) {
  const Stage stage(test::box_room(kBoxSize, 0.5f, 1.0f));
  Camera camera = camera_inside();
  camera.eye = Vec3(0.0f, 0.0f, 50.0f);
  camera.forward = Vec3(0, 0, 1);
  VirtualLights pool;
  add_light(pool, LightKind::kPoint, Vec3(0.1f), Vec3(0, 0, 1), Rgb(1.0f));
  const std::vector<double> weights = importance(
      {stage.scene, stage.world, *stage.tracer, stage.emitters, camera}, pool, options_of(8, 8));
  EXPECT_EQ(weights, std::vector<double>{0.0});
}

TEST(Importance, DoesNotDependOnThreads) {
  const Stage stage(test::box_room(kBoxSize, 0.5f, 1.0f));
  const Camera camera = camera_inside();
  WalkOptions walk_with;
  walk_with.paths = 64;
  const VirtualLights pool =
      walk(stage.scene, stage.world, *stage.tracer, stage.emitters, walk_with);
  std::vector<std::vector<double>> all;
  for (const int threads : {1, 3}) {
    ThreadScope scope(threads);
    scope.run([&] {
      all.push_back(importance({stage.scene, stage.world, *stage.tracer, stage.emitters, camera},
                               pool, options_of(100, 80)));
    });
  }
  EXPECT_EQ(all[0], all[1]);
}

}  // namespace
}  // namespace lantern
