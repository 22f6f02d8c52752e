// SPDX-License-Identifier: MIT
// Convex patches: what known shapes fall into, and that rays from them never meet their own patch.
#include "lantern/raster/convex_patches.h"

#include "lantern/core/hash.h"

#include "tests/raster/raster_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace lantern {
namespace {

struct Patches {
  Scene scene;
  World world;
  ConvexPatches patches;

  explicit Patches(Scene of) : scene(std::move(of)), world(make_world(scene)) {
    patches = find_convex_patches(world, find_neighbours(scene, world));
  }
};

Scene only(Mesh mesh) {
  Scene scene;
  scene.materials.resize(1);
  mesh.material = to_id<MaterialId>(0);
  scene.meshes = {std::move(mesh)};
  scene.instances.resize(1);
  return scene;
}

/// Sheets of 4 by 4 squares whose heights `height` tells.
template <typename Height>
Mesh sheet(Height height) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 25; ++i) {
    const float x = static_cast<float>(i % 5), y = static_cast<float>(i / 5);
    mesh.positions.emplace_back(x, y, height(x, y));
    if (i % 5 == 4 || i / 5 == 4) continue;
    mesh.triangles.emplace_back(i, i + 1, i + 6);
    mesh.triangles.emplace_back(i, i + 6, i + 5);
  }
  return mesh;
}

TEST(ConvexPatches, ABallIsOneWithItsFrontOutside) {
  const Patches all(only(test::ball(16, 16, {})));
  ASSERT_EQ(all.patches.patches.size(), 1u);
  for (const std::uint32_t side : all.patches.sides) EXPECT_EQ(side, kFrontIsOutside);
}

TEST(ConvexPatches, AFlatSheetIsOneOfBothSides) {
  const Patches all(only(sheet([](float, float) { return 0.5f; })));
  ASSERT_EQ(all.patches.patches.size(), 1u);
  for (const std::uint32_t side : all.patches.sides) EXPECT_EQ(side, 3u);
}

TEST(ConvexPatches, ARoofIsOneWithItsUpperSideOutsideWhicheverIsItsFront) {
  Mesh roof = sheet([](float x, float) { return -std::abs(x - 2.0f); });
  EXPECT_EQ(Patches(only(roof)).patches.sides, std::vector<std::uint32_t>(32, kFrontIsOutside));
  for (std::size_t i = 0; i < roof.triangles.size(); i += 3) {
    std::swap(roof.triangles[i].x, roof.triangles[i].y);
  }
  const Patches mixed(only(roof));
  ASSERT_EQ(mixed.patches.patches.size(), 1u);
  for (std::size_t t = 0; t < 32; ++t) {
    EXPECT_EQ(mixed.patches.sides[t], t % 3 == 0 ? kBackIsOutside : kFrontIsOutside);
  }
}

TEST(ConvexPatches, AZigzagFallsApartWhereItTurnsTheOtherWay) {
  const Patches all(
      only(sheet([](float x, float) { return x == 1.0f || x == 3.0f ? 1.0f : 0.0f; })));
  EXPECT_EQ(all.patches.patches.size(), 2u);
}

/// The law that shaders rest on.
TEST(ConvexPatches, RaysThatLeaveOnTheOuterSideMeetNoTriangleOfTheirPatch) {
  Scene scene = only(sheet([](float x, float y) {
    return 0.4f * to_unit_float(hash(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)));
  }));
  scene.meshes.push_back(test::ball(7, 5, to_id<MaterialId>(0)));
  Instance& ball = scene.instances.emplace_back();
  ball.mesh = to_id<MeshId>(1);
  ball.transform = glm::scale(Mat4(1.0f), Vec3(1.0f, 0.6f, 1.4f));
  const Patches all(std::move(scene));
  const World& world = all.world;
  EXPECT_LT(all.patches.patches.size(), world.size());
  EXPECT_EQ(std::set<std::uint32_t>(all.patches.order.begin(), all.patches.order.end()).size(),
            world.size());
  for (const ConvexPatches::Patch& patch : all.patches.patches) {
    World one = world;
    one.triangles.clear();
    for (std::uint32_t i = 0; i < patch.count; ++i) {
      one.triangles.push_back(world.triangles[all.patches.order[patch.first + i]]);
    }
    one.materials.assign(one.triangles.size(), to_id<MaterialId>(0));
    const auto tracer = make_embree_tracer(all.scene, one);
    for (std::uint64_t n = 0; n < 2000; ++n) {
      const auto number = [&](std::uint64_t i) { return to_unit_float(hash(n, patch.first, i)); };
      const std::uint32_t t =
          all.patches.order[patch.first + static_cast<std::uint32_t>(n) % patch.count];
      ASSERT_EQ(&all.patches.patches[all.patches.patch_of[t]], &patch);
      const uvec3 v = world.triangles[t];
      Vec2 at(number(0), number(1));
      if (at.x + at.y > 1.0f) at = 1.0f - at;
      const Vec3 a = world.positions[v.x];
      const Vec3 point = a + at.x * (world.positions[v.y] - a) + at.y * (world.positions[v.z] - a);
      Vec3 outer = glm::normalize(world.area_vector(t));
      if (all.patches.sides[t] == kBackIsOutside) outer = -outer;
      Ray ray;
      ray.origin = off_surface(point, outer, world.coordinate_scale());
      ray.direction = glm::normalize(Vec3(number(2), number(3), number(4)) - 0.5f);
      if (glm::dot(ray.direction, outer) < 0.0f) ray.direction = -ray.direction;
      EXPECT_FALSE(tracer->occluded(ray)) << n;
    }
  }
}

}  // namespace
}  // namespace lantern
