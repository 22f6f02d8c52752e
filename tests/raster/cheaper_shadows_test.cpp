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
    const World world = make_world(test::own_scene(name));
    for (const std::size_t samples : {1u, 16u, 1'000'000u}) {
      EXPECT_EQ(cheaper_shadows(world, world, samples), ShadowMethod::kVolumes) << name;
    }
  }
}

TEST(CheaperShadows, AreMapsOnceManySilhouettesAreDrawnOftenEnough) {
  const World world = make_world(test::room_of_balls(16, 16));
  EXPECT_EQ(cheaper_shadows(world, world, 1), ShadowMethod::kVolumes);
  EXPECT_EQ(cheaper_shadows(world, world, 1000), ShadowMethod::kMaps);
  std::size_t changes = 0;
  for (std::size_t samples = 1; samples < 1000; samples *= 2) {
    changes += cheaper_shadows(world, world, samples) != cheaper_shadows(world, world, 2 * samples)
                   ? 1
                   : 0;
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
  const World a = make_world(closed), b = make_world(torn);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(cheaper_shadows(a, a, 2), ShadowMethod::kVolumes);
  EXPECT_EQ(cheaper_shadows(b, b, 2), ShadowMethod::kMaps);
}

}  // namespace
}  // namespace lantern
