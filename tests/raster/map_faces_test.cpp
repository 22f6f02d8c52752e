// SPDX-License-Identifier: MIT
// How lights unfold into maps, without GL: every direction has one place, and straight lines stay.
#include "lantern/raster/map_faces.h"

#include "lantern/core/hash.h"
#include "lantern/raster/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace lantern {
namespace {

constexpr int kSize = 64;

float number(std::uint64_t i, std::uint64_t n) { return 2.0f * to_unit_float(hash(i, n)) - 1.0f; }

Vec3 direction(std::uint64_t i) {
  return glm::normalize(Vec3(number(i, 0), number(i, 1), number(i, 2)) + 1e-6f);
}

Bounds cube() {
  Bounds bounds;
  bounds.add(Vec3(-3.0f));
  bounds.add(Vec3(3.0f));
  return bounds;
}

/// As shaders/shadow_maps.glsl finds it.
Vec2 unfolded(const MapFrame& frame, const Vec3& way) {
  const Vec3 local(glm::dot(Vec3(frame.x), way), glm::dot(Vec3(frame.y), way),
                   glm::dot(Vec3(frame.z), way));
  const Vec2 at = Vec2(local) / (std::abs(local.x) + std::abs(local.y) + std::abs(local.z));
  if (local.z >= 0.0f) return at;
  return (1.0f - Vec2(std::abs(at.y), std::abs(at.x))) *
         Vec2(at.x >= 0.0f ? 1.0f : -1.0f, at.y >= 0.0f ? 1.0f : -1.0f);
}

LightGroup two_lights(LightFormula formula) {
  LightGroup group{.formula = formula, .records = {}, .points = {}};
  for (std::uint64_t i = 0; i < 2; ++i) {
    LightRecord record;
    record.place = Vec4(direction(10 + i), 0.0f);
    record.axis = Vec4(direction(20 + i), 0.0f);
    group.records.push_back(record);
  }
  return group;
}

/// The same of a light that shines to one side.
Vec2 unfolded_half(const MapFrame& frame, const Vec3& way) {
  const Vec2 local(glm::dot(Vec3(frame.x), way), glm::dot(Vec3(frame.y), way));
  return local / (std::max(std::abs(local.x), std::abs(local.y)) + glm::dot(Vec3(frame.z), way));
}

bool is_inside_edges(const MapFace& face, const Vec2& texel) {
  const auto size = static_cast<float>(kSize);
  const Vec3 off(2.0f * texel - size, size);
  return glm::dot(face.edges[0], off) >= 0.0f && glm::dot(face.edges[1], off) >= 0.0f;
}

/// How many faces draw the point, which none may draw elsewhere than at `at` of the map.
int drawn_at(const std::vector<MapFace>& faces, const Vec3& point, Vec2 at) {
  int drawn = 0;
  for (const MapFace& face : faces) {
    const Vec4 clip = face.clip * Vec4(point - face.origin, 1.0f);
    if (std::max(std::abs(clip.x), std::abs(clip.y)) > clip.w) continue;
    const Vec2 texel =
        Vec2(face.x, face.y) + (0.5f * Vec2(clip) / clip.w + 0.5f) * Vec2(face.width, face.height);
    const Vec2 expected = (0.5f * at + 0.5f) * static_cast<float>(kSize);
    if (!is_inside_edges(face, texel)) continue;
    EXPECT_LT(glm::length(texel - expected), 1e-2f);
    ++drawn;
    EXPECT_GT(glm::dot(face.depth, point - face.origin), 0.0f);
  }
  return drawn;
}

TEST(MapFaces, ALightOfASurfaceHasItsHemisphere) {
  const LightGroup group = two_lights(LightFormula::kSurface);
  const std::vector<MapFrame> frames = map_frames(group, {cube(), cube()}, kSize);
  for (std::size_t light = 0; light < 2; ++light) {
    const auto faces = map_faces(frames[light], group.formula, cube(), kSize, ClipRange::kFarIs0);
    EXPECT_EQ(faces.size(), 4u);
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const Vec3 way = direction(i);
      const float cos_at_light = glm::dot(way, Vec3(group.records[light].axis));
      if (cos_at_light < 1e-3f) continue;
      const Vec2 at = unfolded_half(frames[light], way);
      EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), 1.0f);
      const Vec3 point = Vec3(group.records[light].place) + way * (1.0f + number(i, 5));
      EXPECT_EQ(drawn_at(faces, point, at), 1) << i;
    }
  }
}

TEST(MapFaces, APointHasAllDirections) {
  const LightGroup group = two_lights(LightFormula::kPunctual);
  const std::vector<MapFrame> frames = map_frames(group, {cube(), cube()}, kSize);
  const auto faces = map_faces(frames[1], group.formula, cube(), kSize, ClipRange::kFarIs1);
  EXPECT_EQ(faces.size(), 8u);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Vec3 way = direction(i);
    const Vec3 point = Vec3(group.records[1].place) + 0.5f * way;
    EXPECT_GE(drawn_at(faces, point, unfolded(frames[1], way)), 1) << i;
  }
}

TEST(MapFaces, FromInfinityAllOfTheSceneIsInside) {
  const LightGroup group = two_lights(LightFormula::kDirectional);
  const MapFrame frame = map_frames(group, {cube(), cube()}, kSize)[0];
  for (const ClipRange range : {ClipRange::kFarIs0, ClipRange::kFarIs1}) {
    const auto faces = map_faces(frame, group.formula, cube(), kSize, range);
    ASSERT_EQ(faces.size(), 1u);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p = Vec3(corner & 1, corner >> 1 & 1, corner >> 2) * 6.0f - 3.0f;
      const Vec4 clip = faces[0].clip * Vec4(p - faces[0].origin, 1.0f);
      EXPECT_LT(std::max(std::abs(clip.x), std::abs(clip.y)), 1.0f);
      EXPECT_LT(std::abs(clip.z), 1.0f);
      EXPECT_GT(clip.z, range == ClipRange::kFarIs0 ? 0.0f : -1.0f);
      EXPECT_NEAR(clip.x, glm::dot(Vec3(frame.x), p) + frame.x.w, 1e-5f);
      EXPECT_NEAR(glm::dot(faces[0].depth, p - faces[0].origin),
                  glm::dot(Vec3(frame.z), p) + frame.z.w, 1e-5f);
    }
  }
}

TEST(MapFaces, FromInfinityABoxThatIsLookedAtFillsTheMap) {
  const LightGroup group = two_lights(LightFormula::kDirectional);
  const Bounds seen = snapped({Vec3(0.4f, -1.1f, 2.0f), Vec3(0.9f, -0.8f, 2.9f)}, cube());
  const MapFrame frame = map_frames(group, {cube(), seen}, kSize)[0];
  const MapFace face = map_faces(frame, group.formula, cube(), kSize, ClipRange::kFarIs0)[0];
  float widest = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    const Vec4 clip = face.clip * Vec4(glm::mix(seen.low, seen.high, high) - face.origin, 1.0f);
    EXPECT_LT(std::max(std::abs(clip.x), std::abs(clip.y)), 1.0f);
    widest = std::max(widest, std::max(std::abs(clip.x), std::abs(clip.y)));
    // What casts shadows there may be anywhere in the scene.
    const Vec4 far = face.clip * Vec4(glm::mix(cube().low, cube().high, high) - face.origin, 1.0f);
    EXPECT_LT(std::abs(far.z), 1.0f);
    EXPECT_GT(far.z, 0.0f);
  }
  EXPECT_GT(widest, 0.95f);
}

TEST(MapFaces, NeighbouringViewsShareABox) {
  const Bounds seen{Vec3(0.4f, -1.1f, 2.0f), Vec3(0.9f, -0.8f, 2.9f)};
  const Bounds box = snapped(seen, cube());
  const Bounds moved = snapped({seen.low + 0.01f, seen.high + 0.01f}, cube());
  EXPECT_EQ(box.low, moved.low);
  EXPECT_EQ(box.high, moved.high);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.low[axis], seen.low[axis]);
    EXPECT_GE(box.high[axis], seen.high[axis]);
    EXPECT_LT(box.high[axis] - box.low[axis], seen.high[axis] - seen.low[axis] + 0.4f);
  }
  EXPECT_TRUE(still_fits(box, moved, cube()));
  // A little more that is seen and gone again takes other maps once.
  const Bounds more = snapped({seen.low - 0.1f, seen.high + 0.1f}, cube());
  EXPECT_FALSE(still_fits(box, more, cube()));
  EXPECT_TRUE(still_fits(more, box, cube()));
  EXPECT_FALSE(still_fits(cube(), box, cube()));
  EXPECT_EQ(snapped({}, cube()).low, cube().low);  // nothing but sky is seen
}

TEST(Clusters, HoldEveryTriangleOnceInsideTheirSpheres) {
  World world;
  for (std::uint32_t i = 0; i < 500; ++i) {
    for (std::uint64_t corner = 0; corner < 3; ++corner) {
      const Vec3 p = direction(i) + 0.05f * direction(1000 + 3 * i + corner);
      world.positions.push_back(p);
      world.bounds.add(p);
    }
    world.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  std::vector<std::uint32_t> order(world.size());
  std::iota(order.begin(), order.end(), 0u);
  const std::vector<Cluster> clusters = make_clusters(world, order);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), world.size());
  std::size_t count = 0;
  float radii = 0.0f;
  for (const Cluster& cluster : clusters) {
    EXPECT_EQ(cluster.first, count);
    count += cluster.count;
    radii += cluster.radius;
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3 p = world.positions[world.triangles[order[i]][corner]];
        EXPECT_LE(glm::length(p - cluster.centre), cluster.radius * 1.001f);
      }
    }
  }
  EXPECT_EQ(count, world.size());
  // Neighbours: eight clusters of any triangles are as large as the sphere.
  EXPECT_LT(radii / static_cast<float>(clusters.size()), 1.3f);
}

TEST(Clusters, AreLeftOutBehindAPlane) {
  const Cluster cluster{0, 1, Vec3(0.0f, 0.0f, 2.0f), 0.5f};
  const std::vector<Vec4> up = {Vec4(0.0f, 0.0f, 1.0f, 0.0f)};
  EXPECT_TRUE(may_lie_inside(cluster, Vec3(0.0f), up));
  EXPECT_TRUE(may_lie_inside(cluster, Vec3(0.0f, 0.0f, 2.4f), up));
  EXPECT_FALSE(may_lie_inside(cluster, Vec3(0.0f, 0.0f, 2.6f), up));
}

}  // namespace
}  // namespace lantern
