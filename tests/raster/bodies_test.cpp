// SPDX-License-Identifier: MIT
// Bodies: what known shapes are cut into, and which of them show one side alone.
#include "lantern/raster/bodies.h"

#include "lantern/raster/neighbours.h"

#include "tests/raster/raster_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace lantern {
namespace {

struct Bodies {
  World world;
  std::vector<std::uint32_t> order;
  std::vector<Body> bodies;

  explicit Bodies(const Scene& scene) : world(make_world(scene)), order(world.size()) {
    std::iota(order.begin(), order.end(), 0u);
    const auto neighbours = find_neighbours(scene, world);
    bodies = make_bodies(world, neighbours, find_parts(neighbours), order);
  }
  std::size_t count(SeenSide side) const {
    return static_cast<std::size_t>(std::count_if(
        bodies.begin(), bodies.end(), [&](const Body& body) { return body.outside == side; }));
  }
};

Scene one_ball() {
  Scene scene;
  scene.materials.resize(2);
  scene.meshes = {test::ball(16, 16, to_id<MaterialId>(0))};
  scene.instances.resize(1);
  return scene;
}

TEST(Bodies, AreTheBallsOfARoomAndWhatIsSmallTogether) {
  const Bodies found(test::room_of_balls(16, 16));
  EXPECT_EQ(found.count(SeenSide::kFront), 64u);
  EXPECT_EQ(found.count(SeenSide::kBoth), 1u);  // the room and its lamp
  std::uint32_t next = 0;
  for (const Body& body : found.bodies) {
    EXPECT_EQ(body.first, next);
    next += body.count;
    for (std::uint32_t i = body.first; i < next; ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3 place = found.world.positions[found.world.triangles[found.order[i]][corner]];
        EXPECT_LE(glm::length(place - body.centre), body.radius * 1.0001f);
      }
    }
  }
  EXPECT_EQ(next, found.world.size());
  std::vector<std::uint32_t> sorted = found.order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
}

TEST(Bodies, AreSeenFromTheirOuterSideAlone) {
  Scene scene = one_ball();
  const Body ball = Bodies(scene).bodies.at(0);
  EXPECT_EQ(ball.outside, SeenSide::kFront);
  EXPECT_EQ(seen_side(ball, Vec3(0.0f, 0.0f, 2.0f)), SeenSide::kFront);
  EXPECT_EQ(seen_side(ball, Vec3(0.0f, 0.5f, 0.0f)), SeenSide::kBoth);  // from inside
  for (uvec3& t : scene.meshes[0].triangles) std::swap(t.y, t.z);
  EXPECT_EQ(Bodies(scene).bodies.at(0).outside, SeenSide::kBack);
}

TEST(Bodies, ThatAreOpenDentedTwistedOrOfTwoMaterialsAreSeenFromBothSides) {
  Scene open = one_ball();
  open.meshes[0].triangles.pop_back();
  EXPECT_EQ(Bodies(open).count(SeenSide::kBoth), 1u);

  Scene dented = one_ball();
  dented.meshes[0].positions[0] *= 0.9f;
  EXPECT_EQ(Bodies(dented).count(SeenSide::kBoth), 1u);

  Scene twisted = one_ball();
  std::swap(twisted.meshes[0].triangles[7].x, twisted.meshes[0].triangles[7].y);
  EXPECT_EQ(Bodies(twisted).count(SeenSide::kBoth), 1u);

  const Scene scene = one_ball();
  const World world = make_world(scene);
  const auto neighbours = find_neighbours(scene, world);
  std::vector<std::uint32_t> half(world.size() / 2);  // as if the rest were of another material
  std::iota(half.begin(), half.end(), 0u);
  for (const Body& body : make_bodies(world, neighbours, find_parts(neighbours), half)) {
    EXPECT_EQ(body.outside, SeenSide::kBoth);
  }
}

TEST(Bodies, ThatTouchAViewLieInsideOfIt) {
  const Body body{0, 1, Vec3(0.0f, 0.0f, 3.0f), 1.0f, SeenSide::kBoth};
  const Vec4 above(0.0f, 0.0f, 1.0f, -3.9f), beyond(0.0f, 0.0f, 1.0f, -4.1f);
  EXPECT_TRUE(may_lie_inside(body, std::span(&above, 1)));
  EXPECT_FALSE(may_lie_inside(body, std::span(&beyond, 1)));
  EXPECT_TRUE(may_lie_inside(body, {}));
}

}  // namespace
}  // namespace lantern
