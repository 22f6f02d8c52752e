// SPDX-License-Identifier: MIT
// Which shadows are chosen: volumes of what has few edges or is looked at once, maps where volumes
// would be drawn again and again.
#include "lantern/raster/cheaper_shadows.h"

#include "tests/raster/raster_scenes.h"

#include <gtest/gtest.h>

namespace lantern {
namespace {

TEST(CheaperShadows, AreVolumesWhereThereAreFewTriangles) {
  for (const char* name : {"cornell_box.scene", "two_rooms.scene"}) {
    const test::RasterStage stage(test::own_scene(name));
    for (const std::size_t samples : {1u, 16u, 1'000'000u}) {
      EXPECT_EQ(cheaper_shadows(stage.world, stage.lights(16), samples), ShadowMethod::kVolumes)
          << name;
    }
  }
}

TEST(CheaperShadows, AreMapsOnceManySilhouettesAreDrawnOftenEnough) {
  const test::RasterStage stage(test::room_of_balls(16, 16));
  const VirtualLights lights = stage.lights(16);
  const auto chosen = [&](std::size_t samples) {
    return cheaper_shadows(stage.world, lights, samples);
  };
  // Both took the same time at 13 when it was measured.
  EXPECT_EQ(chosen(4), ShadowMethod::kVolumes);
  EXPECT_EQ(chosen(40), ShadowMethod::kMaps);
  std::size_t changes = 0;
  for (std::size_t samples = 1; samples < 100; samples *= 2) {
    changes += chosen(samples) != chosen(2 * samples) ? 1 : 0;
  }
  EXPECT_EQ(changes, 1u);
}

/// Of closed meshes the silhouette alone is drawn: a fifth of the quads that their triangles have
/// when they are torn apart.
TEST(CheaperShadows, AreMapsSoonerWhereMeshesAreOpen) {
  const Scene closed = test::room_of_balls(16, 16);
  Scene torn = closed;
  Mesh& ball = torn.meshes[2];
  Mesh apart;
  apart.material = ball.material;
  for (std::uint32_t i = 0; i < ball.triangles.size(); ++i) {
    // Moved by different small ways, so that no edges are shared.
    const Vec3 way(0.0f, 1e-4f * static_cast<float>(i % 97), 0.0f);
    for (int corner = 0; corner < 3; ++corner) {
      apart.positions.push_back(ball.positions[ball.triangles[i][corner]] + way);
    }
    apart.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  ball = apart;
  const test::RasterStage a(closed), b(torn);
  ASSERT_EQ(a.world.size(), b.world.size());
  EXPECT_EQ(cheaper_shadows(a.world, a.lights(16), 2), ShadowMethod::kVolumes);
  EXPECT_EQ(cheaper_shadows(b.world, b.lights(16), 2), ShadowMethod::kMaps);
}

/// A map from infinity takes 20 MiB: of a thousand the most are drawn for every sample.
TEST(CheaperShadows, AreVolumesOfMoreLightsThanMapsCanBeKeptOf) {
  const World world = make_world(test::room_of_balls(16, 16));
  const auto suns = [](std::size_t count) {
    VirtualLights lights;
    for (std::size_t i = 0; i < count; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(count);
      lights.position.emplace_back(0.0f);
      lights.normal.push_back(glm::normalize(Vec3(x, -1.0f, 0.3f)));
      lights.flux.emplace_back(1.0f);
      lights.path.push_back(static_cast<std::uint32_t>(i));
      lights.bounce.push_back(0);
      lights.kind.push_back(LightKind::kDirectional);
      lights.cone.emplace_back(0.0f);
    }
    return lights;
  };
  EXPECT_EQ(cheaper_shadows(world, suns(10), 1000), ShadowMethod::kMaps);
  EXPECT_EQ(cheaper_shadows(world, suns(1000), 1000), ShadowMethod::kVolumes);
}

}  // namespace
}  // namespace lantern
