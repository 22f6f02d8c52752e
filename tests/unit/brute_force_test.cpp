// SPDX-License-Identifier: MIT
#include "lantern/trace/brute_force.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// A mesh with its own copy of the scene around it, ready to trace.
struct Traced {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;

  explicit Traced(Scene given)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_brute_force_tracer(scene, world)) {}
  Traced(const Traced&) = delete;
  Traced& operator=(const Traced&) = delete;
};

Scene scene_of(std::vector<Vec3> positions, std::vector<uvec3> triangles) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back().mesh = MeshId{0};
  return scene;
}

/// In the plane z = 0, front towards +z.
Scene triangle() { return scene_of({{0, 0, 0}, {2, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}); }

/// The corner of the unit cube: three faces in the coordinate planes, one on x + y + z = 1.
Scene tetrahedron() {
  return scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

TEST(BruteForce, HitsATriangleWhereTheAlgebraSays) {
  const Traced traced(triangle());
  // x = 2u and y = 4v on the triangle: (0.5, 1) is u = v = 1/4.
  const Hit hit = traced.tracer->closest({.origin = {0.5f, 1.0f, 3.0f}, .direction = {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.distance, 3.0f);
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_EQ(hit.uv, Vec2(0.25f));
  EXPECT_FALSE(traced.tracer->closest({.origin = {1.5f, 3.0f, 3.0f}, .direction = {0, 0, -1}}));
}

TEST(BruteForce, HitsBothSides) {
  const Traced traced(triangle());
  const Ray from_behind{.origin = {0.5f, 1.0f, -3.0f}, .direction = {0, 0, 1}};
  EXPECT_EQ(traced.tracer->closest(from_behind).distance, 3.0f);
  EXPECT_TRUE(traced.tracer->occluded(from_behind));
}

TEST(BruteForce, CountsDistanceInLengthsOfTheDirection) {
  const Traced traced(triangle());
  const Ray ray{.origin = {1.5f, 1.0f, 4.0f}, .direction = {-0.5f, 0, -2}};
  const Hit hit = traced.tracer->closest(ray);
  EXPECT_EQ(hit.distance, 2.0f);
  EXPECT_EQ(hit.uv, Vec2(0.25f));
}

TEST(BruteForce, LooksBetweenNearAndFar) {
  const Traced traced(triangle());
  Ray ray{.origin = {0.5f, 1.0f, 3.0f}, .direction = {0, 0, -1}};
  const auto meets = [&](float near, float far) {
    ray.near = near;
    ray.far = far;
    const bool hit = static_cast<bool>(traced.tracer->closest(ray));
    EXPECT_EQ(hit, traced.tracer->occluded(ray));
    return hit;
  };
  EXPECT_TRUE(meets(2.9f, 3.1f));
  EXPECT_TRUE(meets(0.0f, 3.0f));
  EXPECT_FALSE(meets(0.0f, 2.9f));
  EXPECT_FALSE(meets(3.0f, kInfinity));
  ray.origin.z = -3.0f;  // the triangle lies behind
  EXPECT_FALSE(meets(0.0f, kInfinity));
}

TEST(BruteForce, MissesWhatIsParallelOrDegenerate) {
  const Traced traced(triangle());
  EXPECT_FALSE(traced.tracer->closest({.origin = {0.5f, 1.0f, 0.0f}, .direction = {1, 0, 0}}));
  EXPECT_FALSE(traced.tracer->closest({.origin = {0.5f, 1.0f, 1.0f}, .direction = {0, 0, 0}}));
}

TEST(BruteForce, FindsTheNearestFaceOfATetrahedron) {
  const Traced traced(tetrahedron());
  // Towards the origin along (1, 1, 1): in at x + y + z = 1, from t = 1 down to 1/3 each.
  const Hit in = traced.tracer->closest({.origin = Vec3(1.0f), .direction = Vec3(-1.0f)});
  EXPECT_FLOAT_EQ(in.distance, 2.0f / 3.0f);
  EXPECT_EQ(in.triangle, 3u);
  EXPECT_FLOAT_EQ(in.uv.x, 1.0f / 3.0f);
  EXPECT_FLOAT_EQ(in.uv.y, 1.0f / 3.0f);

  // From inside, each axis leads out through the face across it.
  const Vec3 inside(0.125f, 0.25f, 0.125f);
  const Hit down = traced.tracer->closest({.origin = inside, .direction = {0, 0, -1}});
  EXPECT_EQ(down.triangle, 0u);
  EXPECT_EQ(down.distance, 0.125f);
  EXPECT_EQ(down.uv, Vec2(0.25f, 0.125f));  // weights of (0, 1, 0) and (1, 0, 0)
  EXPECT_EQ(traced.tracer->closest({.origin = inside, .direction = {0, -1, 0}}).triangle, 1u);
  EXPECT_EQ(traced.tracer->closest({.origin = inside, .direction = {-1, 0, 0}}).triangle, 2u);
  const Hit up = traced.tracer->closest({.origin = inside, .direction = {0, 0, 1}});
  EXPECT_EQ(up.triangle, 3u);
  EXPECT_EQ(up.distance, 0.5f);
}

/// The triangle with a texture of two texels: the one of the smaller u is a hole.
Scene masked() {
  Scene scene = triangle();
  Texture& mask = scene.textures.emplace_back();
  mask.width = 2;
  mask.height = 1;
  mask.srgb8 = {255, 255, 255, 0, 255, 255, 255, 255};
  mask.wrap_u = Wrap::kClamp;
  scene.materials[0].reflectance_texture = TextureId{0};
  scene.materials[0].alpha_cutoff = 0.5f;
  scene.meshes[0].texcoords = {{0, 0}, {1, 0}, {0, 1}};
  return scene;
}

TEST(BruteForce, PassesThroughHoles) {
  const Traced traced(masked());
  const Ray through{.origin = {0.25f, 1.0f, 3.0f}, .direction = {0, 0, -1}};
  const Ray onto{.origin = {1.5f, 0.5f, 3.0f}, .direction = {0, 0, -1}};
  EXPECT_FALSE(traced.tracer->closest(through));
  EXPECT_FALSE(traced.tracer->occluded(through));
  EXPECT_TRUE(traced.tracer->closest(onto));
  EXPECT_TRUE(traced.tracer->occluded(onto));
}

TEST(BruteForce, FindsWhatLiesBehindAHole) {
  Scene scene = masked();
  Mesh behind = triangle().meshes[0];
  for (Vec3& p : behind.positions) p.z = -1.0f;
  scene.materials.emplace_back();
  behind.material = MaterialId{1};
  scene.meshes.push_back(std::move(behind));
  scene.instances.emplace_back().mesh = MeshId{1};
  const Traced traced(std::move(scene));
  const Hit hit = traced.tracer->closest({.origin = {0.25f, 1.0f, 3.0f}, .direction = {0, 0, -1}});
  EXPECT_EQ(hit.distance, 4.0f);
  EXPECT_EQ(hit.triangle, 1u);
}

TEST(BruteForce, TracesPacketsLaneByLane) {
  const Traced traced(triangle());
  RayPacket packet{};
  LaneMask active{};
  for (int i = 0; i < kPacket; ++i) {
    packet.origin_x[i] = 0.25f * static_cast<float>(i);  // the triangle ends at x = 1.75
    packet.origin_y[i] = 0.5f;
    packet.origin_z[i] = 2.0f;
    packet.direction_z[i] = -1.0f;
    packet.far[i] = 10.0f;
    active.lane[i] = i == 3 ? 0 : -1;
  }
  Hit hits[kPacket];
  hits[3].distance = 1.0f;
  traced.tracer->closest(active, packet, hits);
  traced.tracer->occluded(active, packet);
  for (int i = 0; i < kPacket; ++i) {
    const bool expected = i <= 7 && i != 3;
    EXPECT_EQ(static_cast<bool>(hits[i]), expected) << i;
    EXPECT_EQ(packet.far[i] < 0.0f, expected) << i;
    if (expected) {
      EXPECT_EQ(hits[i].distance, 2.0f);
      EXPECT_EQ(hits[i].uv, Vec2(0.125f * static_cast<float>(i), 0.125f));
    }
  }
}

}  // namespace
}  // namespace lantern
