// SPDX-License-Identifier: MIT
// Shadow volumes without GL. What is shown of every kind of mesh: the count at a point, taken from
// the eye's and the quads on the way there, is that of the triangles between light and point, each
// of them tried in double precision.
#include "lantern/raster/edge_list.h"

#include "lantern/core/hash.h"
#include "lantern/raster/silhouettes.h"

#include "tests/support/numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace lantern {
namespace {

using glm::dvec3;
using test::Numbers;
using ::testing::AnyOf;
using ::testing::SizeIs;

void add(Scene& scene, std::vector<Vec3> positions, std::vector<uvec3> triangles,
         const Mat4& transform = Mat4(1.0f)) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  Instance instance;
  instance.mesh = static_cast<MeshId>(scene.meshes.size());
  instance.transform = transform;
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(instance);
}

const std::vector<Vec3> kTetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<uvec3> kTetrahedronFaces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

Scene tetrahedron() {
  Scene scene;
  add(scene, kTetrahedron, kTetrahedronFaces);
  return scene;
}

Scene open_quad() {
  Scene scene;
  add(scene, {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, {{0, 1, 2}, {0, 2, 3}});
  return scene;
}

/// Three triangles that meet in an edge, the third one turned against the others.
Scene fan_of_three() {
  Scene scene;
  add(scene, {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-0.5f, 0.8f, 0}, {-0.5f, -0.8f, 0}},
      {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}});
  return scene;
}

/// A tetrahedron and its mirror image, face on face: their common face is there twice, and edges
/// have four triangles.
Scene mirrored_twins() {
  Scene scene = tetrahedron();
  add(scene, kTetrahedron, kTetrahedronFaces, glm::scale(Mat4(1.0f), Vec3(-1.0f, 1.0f, 1.0f)));
  return scene;
}

/// Both sides of a quad as triangles of their own.
Scene doubled_quad() {
  Scene scene = open_quad();
  scene.meshes[0].triangles.insert(scene.meshes[0].triangles.end(), {{0, 2, 1}, {0, 3, 2}});
  return scene;
}

/// Triangles through each other, half of them sharing vertices in all orders, and a closed mesh.
Scene soup() {
  Scene scene = tetrahedron();
  Numbers numbers(7);
  std::vector<Vec3> positions;
  std::vector<uvec3> triangles;
  for (int i = 0; i < 12; ++i) positions.push_back(numbers.in_box(1.0f));
  for (std::uint32_t i = 0; i < 40; ++i) {
    uvec3 t;
    for (int corner = 0; corner < 3; ++corner) {
      t[corner] = static_cast<std::uint32_t>(hash(i, static_cast<std::uint64_t>(corner)) % 12);
    }
    if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
  }
  add(scene, positions, triangles);
  return scene;
}

/// A box without a floor on a floor in a room whose walls have no thickness.
Scene furnished_room() {
  Scene scene;
  const std::vector<Vec3> corners = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                     {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  std::vector<uvec3> sides = {{4, 5, 6}, {4, 6, 7}, {1, 0, 3}, {1, 3, 2}, {5, 1, 2},
                              {5, 2, 6}, {0, 4, 7}, {0, 7, 3}, {7, 6, 2}, {7, 2, 3}};
  const Mat4 low = glm::translate(Mat4(1.0f), Vec3(0.1f, -2.0f, 0.2f));
  add(scene, corners, sides, glm::rotate(low, 0.3f, Vec3(0, 1, 0)));
  std::vector<uvec3> walls = sides;
  walls.insert(walls.end(), {{0, 1, 5}, {0, 5, 4}});
  add(scene, corners, walls, glm::scale(Mat4(1.0f), Vec3(3.0f)));
  return scene;
}

double determinant(const dvec3& a, const dvec3& b, const dvec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

/// 1 if the segment crosses the triangle from its front, -1 from its back, 0 not at all.
int crossing(const World& world, std::uint32_t triangle, const dvec3& from, const dvec3& to) {
  const uvec3 v = world.triangles[triangle];
  const dvec3 a(world.positions[v.x]), b(world.positions[v.y]), c(world.positions[v.z]);
  const dvec3 normal = glm::cross(b - a, c - a);
  const bool front = glm::dot(normal, from - a) > 0.0;
  if (front == (glm::dot(normal, to - a) > 0.0)) return 0;
  const dvec3 way = to - from;
  const bool ab = determinant(a - from, b - from, way) > 0.0;
  const bool bc = determinant(b - from, c - from, way) > 0.0;
  const bool ca = determinant(c - from, a - from, way) > 0.0;
  if (ab != bc || bc != ca) return 0;
  return front ? 1 : -1;
}

/// Where shadow rays to the light end.
dvec3 end_at(const LightPoint& light, const dvec3& point) {
  constexpr double kFar = 1e3;
  return light.w != 0.0f ? dvec3(light) : point + kFar * dvec3(light);
}

int blockers(const World& world, const LightPoint& light, const dvec3& point) {
  int count = 0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    count += std::abs(crossing(world, t, point, end_at(light, point)));
  }
  return count;
}

/// 1 if the segment enters a volume through this quad, -1 if it leaves one, 0 if it passes by.
int quad_crossing(const EdgeList& list, const VolumeEdge& edge, const LightPoint& light,
                  const dvec3& from, const dvec3& to) {
  const dvec3 a(list.vertices()[edge.from]), b(list.vertices()[edge.to]), l(light);
  const double w = light.w;
  const dvec3 down_a = w * a - l, down_b = w * b - l, way = to - from;
  // A point of the plane lies in the quad where it is on the quad's side of its three edges.
  const dvec3 outward = glm::cross(a - b, down_a);
  const double before = glm::dot(outward, from - a), after = glm::dot(outward, to - a);
  if ((before > 0.0) == (after > 0.0)) return 0;
  const dvec3 p = from + way * (before / (before - after));
  if (glm::dot(glm::cross(down_a, p - a), outward) * glm::dot(glm::cross(down_a, b - a), outward) <
      0.0) {
    return 0;
  }
  if (glm::dot(glm::cross(down_b, p - b), outward) * glm::dot(glm::cross(down_b, a - b), outward) <
      0.0) {
    return 0;
  }
  if (glm::dot(glm::cross(b - a, p - a), outward) * glm::dot(glm::cross(b - a, down_a), outward) <
      0.0) {
    return 0;
  }
  return before > 0.0 ? 1 : -1;
}

struct Case {
  const char* name;
  Scene (*scene)();
};
void PrintTo(const Case& tested, std::ostream* out) { *out << tested.name; }

class Volumes : public ::testing::TestWithParam<Case> {
 protected:
  World world_ = make_world(GetParam().scene());
  Numbers numbers_{42};

  LightPoint random_light(int i) {
    const Vec3 place = numbers_.in_box(0.9f * world_.bounds.radius());
    return i % 4 == 3 ? LightPoint(glm::normalize(place), 0.0f) : LightPoint(place, 1.0f);
  }
};
INSTANTIATE_TEST_SUITE_P(Meshes, Volumes,
                         ::testing::Values(Case{"tetrahedron", tetrahedron},
                                           Case{"open quad", open_quad},
                                           Case{"three on an edge", fan_of_three},
                                           Case{"mirrored", mirrored_twins},
                                           Case{"doubled quad", doubled_quad}, Case{"soup", soup},
                                           Case{"room", furnished_room}),
                         [](const ::testing::TestParamInfo<Case>& tested) {
                           std::string name = tested.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST_P(Volumes, CountTheTrianglesBetweenAnyPointAndTheLight) {
  const EdgeList list(world_);
  int shadowed = 0;
  for (int i = 0; i < 100; ++i) {
    const LightPoint light = random_light(i);
    const Vec3 eye = numbers_.in_box(world_.bounds.radius());
    const ShadowVolumes volumes = list.volumes(light, eye, VolumeCount::kPlain);
    ASSERT_EQ(volumes.eye_count, blockers(world_, light, dvec3(eye)));
    for (int k = 0; k < 20; ++k) {
      const dvec3 point(numbers_.in_box(world_.bounds.radius()));
      int count = volumes.eye_count;
      for (const VolumeEdge& edge : volumes.edges) {
        count += quad_crossing(list, edge, light, dvec3(eye), point);
      }
      // Through a triangle itself, from its lit side into its shadow or back.
      for (std::uint32_t t = 0; t < world_.size(); ++t) {
        const dvec3 a(world_.positions[world_.triangles[t].x]);
        const double w = light.w;
        const bool lit_front = glm::dot(dvec3(world_.area_vector(t)), dvec3(light) - w * a) > 0.0;
        count += (lit_front ? 1 : -1) * crossing(world_, t, dvec3(eye), point);
      }
      ASSERT_EQ(count, blockers(world_, light, point)) << "light " << i << " point " << k;
      shadowed += count > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(shadowed, 20);
}

TEST_P(Volumes, HalvedAndInsideWallsStillTellLightFromShadowWhereverOneSees) {
  const std::vector<Vec4> all_walls = find_walls(world_);
  int lit = 0, shadowed = 0;
  for (int i = 0; i < 200; ++i) {
    const LightPoint light = random_light(i);
    const Vec3 eye = numbers_.in_box(0.9f * world_.bounds.radius());
    std::vector<Vec4> walls;
    for (const Vec4& wall : all_walls) {
      const std::array<Vec4, 1> one = {wall};
      if (is_inside(one, light) && is_inside(one, Vec4(eye, 1.0f))) walls.push_back(wall);
    }
    const EdgeList list(world_, walls);
    // Half of them with silhouettes that may be off by less than is seen here.
    const float slack = i % 2 == 0 ? 0.0f : 1e-6f;
    const ShadowVolumes volumes = list.volumes(light, eye, VolumeCount::kHalved, {}, slack);
    for (int k = 0; k < 20; ++k) {
      // Up to a little before what is seen that way, if anything is.
      dvec3 point = dvec3(eye) + 4.0 * dvec3(numbers_.in_box(world_.bounds.radius()));
      const bool sees_nothing = [&] {
        double nearest = 2.0;
        for (std::uint32_t t = 0; t < world_.size(); ++t) {
          if (crossing(world_, t, dvec3(eye), point) == 0) continue;
          const dvec3 a(world_.positions[world_.triangles[t].x]), n(world_.area_vector(t));
          nearest =
              std::min(nearest, glm::dot(n, a - dvec3(eye)) / glm::dot(n, point - dvec3(eye)));
        }
        if (nearest <= 1.0) point = glm::mix(dvec3(eye), point, 0.999999 * nearest);
        return nearest > 1.0;
      }();
      if (sees_nothing) continue;
      int count = volumes.eye_count;
      for (const VolumeEdge& edge : volumes.edges) {
        count += quad_crossing(list, edge, light, dvec3(eye), point);
      }
      const bool is_lit = count == 0 && !volumes.dark;
      ASSERT_EQ(is_lit, blockers(world_, light, point) == 0) << "light " << i << " point " << k;
      (is_lit ? lit : shadowed) += 1;
    }
  }
  EXPECT_GT(lit, 20);
  EXPECT_GT(shadowed, 20);
}

TEST(EdgeList, LeavesOutPartsThatThrowNoShadowOnWhatIsAskedFor) {
  Numbers numbers(11);
  Scene scene;
  for (int i = 0; i < 40; ++i) {
    const Mat4 place = glm::translate(Mat4(1.0f), numbers.in_box(4.0f));
    add(scene, kTetrahedron, kTetrahedronFaces, glm::scale(place, Vec3(0.6f)));
  }
  const World world = make_world(scene);
  const EdgeList list(world);
  std::size_t all_edges = 0, edges = 0;
  int compared = 0, shadowed = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 place = numbers.in_box(5.0f), eye = numbers.in_box(5.0f);
    const LightPoint light(i % 4 == 3 ? glm::normalize(place) : place, i % 4 == 3 ? 0.0f : 1.0f);
    // Two sides of a view, and one that the light shines to.
    std::vector<Vec4> region;
    for (int k = 0; k < 3; ++k) {
      const Vec3 normal = glm::normalize(numbers.in_box(1.0f));
      region.emplace_back(normal, -glm::dot(normal, k < 2 ? eye : place));
    }
    const ShadowVolumes all = list.volumes(light, eye, VolumeCount::kPlain);
    const ShadowVolumes few = list.volumes(light, eye, VolumeCount::kPlain, region);
    all_edges += all.edges.size();
    edges += few.edges.size();
    for (int k = 0; k < 40; ++k) {
      const Vec3 point = numbers.in_box(5.0f);
      bool is_seen = is_inside(region, LightPoint(point, 1.0f));
      for (std::uint32_t t = 0; t < world.size() && is_seen; ++t) {
        is_seen = crossing(world, t, dvec3(eye), dvec3(point)) == 0;
      }
      if (!is_seen) continue;
      const auto count = [&](const ShadowVolumes& volumes) {
        int sum = volumes.eye_count;
        for (const VolumeEdge& edge : volumes.edges) {
          sum += quad_crossing(list, edge, light, dvec3(eye), dvec3(point));
        }
        return sum;
      };
      ASSERT_EQ(count(few), count(all)) << "light " << i << " point " << k;
      ++compared;
      shadowed += count(all) != 0 ? 1 : 0;
    }
  }
  EXPECT_LT(edges, all_edges * 3 / 4);
  EXPECT_GT(shadowed, compared / 20);
  EXPECT_GT(compared, 100);
}

TEST_P(Volumes, SilhouettesOfFewerEdgesAndWhatIsCutOffAreAsMuchAsAll) {
  const EdgeList list(world_);
  std::size_t before = 0, after = 0;
  for (int i = 0; i < 50; ++i) {
    const LightPoint light = random_light(i);
    const ShadowVolumes volumes = list.volumes(light, numbers_.in_box(world_.bounds.radius()));
    std::vector<VolumeEdge> edges = volumes.edges;
    SilhouetteSimplifier simplifier(list.vertices(), light);
    const auto cut_off = simplifier.simplify(edges, 0, 0.3f * world_.bounds.radius());
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> times;
    const auto count = [&](std::uint32_t from, std::uint32_t to, int by) {
      if (from < to) times[{from, to}] += by;
      if (to < from) times[{to, from}] -= by;
    };
    for (const VolumeEdge& edge : volumes.edges) count(edge.from, edge.to, 1);
    for (const VolumeEdge& edge : edges) count(edge.from, edge.to, -1);
    for (const uvec3& t : cut_off) {
      for (int corner = 0; corner < 3; ++corner) count(t[corner], t[(corner + 1) % 3], -1);
    }
    for (const auto& [edge, left] : times) ASSERT_EQ(left, 0) << edge.first << " " << edge.second;
    ASSERT_EQ(edges.size() + cut_off.size(), volumes.edges.size());
    before += volumes.edges.size();
    after += edges.size();
  }
  EXPECT_LT(after, before);
}

/// A ball around the origin, cut into so many columns and half as many rows.
Scene ball(std::uint32_t columns, float radius = 1.0f) {
  const std::uint32_t rows = columns / 2;
  const auto at = [&](std::uint32_t row, std::uint32_t column) {
    const float down = glm::pi<float>() * static_cast<float>(row) / static_cast<float>(rows);
    const float round =
        glm::two_pi<float>() * static_cast<float>(column % columns) / static_cast<float>(columns);
    return Vec3(std::sin(down) * std::cos(round), std::cos(down), std::sin(down) * std::sin(round));
  };
  std::vector<Vec3> positions = {{0, radius, 0}, {0, -radius, 0}};
  std::vector<uvec3> triangles;
  const auto number = [&](std::uint32_t row, std::uint32_t column) {
    if (row == 0) return 0u;
    return row == rows ? 1u : 2 + (row - 1) * columns + column % columns;
  };
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      if (row > 0) positions.push_back(radius * at(row, column));
      const std::uint32_t a = number(row, column), b = number(row, column + 1);
      const std::uint32_t c = number(row + 1, column), d = number(row + 1, column + 1);
      if (a != b) triangles.emplace_back(a, b, d);
      if (c != d) triangles.emplace_back(a, d, c);
    }
  }
  Scene scene;
  add(scene, positions, triangles);
  return scene;
}

TEST(EdgeList, SilhouettesOfFewerEdgesAreOffByNoMoreThanAskedFor) {
  const World world = make_world(ball(48));
  const EdgeList list(world);
  const World core = make_world(ball(48, 0.98f));
  constexpr float kFar = 6.0f;
  Numbers numbers(3);
  int lit = 0, shadowed = 0, off = 0, eyes_in_shadow = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 way = glm::normalize(numbers.in_box(1.0f));
    const LightPoint light = i % 3 == 2 ? LightPoint(way, 0.0f) : LightPoint(2.0f * way, 1.0f);
    // A point that the ball's rim hides from the light, or nearly: so far from the axis is the ray
    // that leaves the light beside the ball.
    const auto near_rim = [&](float low, float high) {
      const Vec3 side = glm::normalize(glm::cross(way, numbers.in_box(1.0f)));
      const float sine = numbers.in(low, high) / 2.0f, far = numbers.in(3.0f, kFar);
      if (light.w == 0.0f) return 2.0f * sine * side - (far - 2.0f) * way;
      return Vec3(light) + far * (sine * side - std::sqrt(1.0f - sine * sine) * way);
    };
    const Vec3 eye = i % 2 == 0 ? near_rim(0.96f, 1.01f) : near_rim(0.0f, 2.0f);
    const ShadowVolumes exact = list.volumes(light, eye);
    const ShadowVolumes few = list.volumes(light, eye, VolumeCount::kHalved, {}, 1.0f);
    ASSERT_FALSE(few.dark);
    EXPECT_LT(few.edges.size(), exact.edges.size() / 2);
    eyes_in_shadow += few.eye_count != 0 ? 1 : 0;
    for (int k = 0; k < 40; ++k) {
      const Vec3 point = k % 2 == 0 ? near_rim(0.96f, 1.01f) : near_rim(0.0f, 2.0f);
      bool is_seen = true;
      for (std::uint32_t t = 0; t < world.size() && is_seen; ++t) {
        is_seen = crossing(world, t, dvec3(eye), dvec3(point)) == 0;
      }
      if (!is_seen) continue;
      int count = few.eye_count;
      for (const VolumeEdge& edge : few.edges) {
        count += quad_crossing(list, edge, light, dvec3(eye), dvec3(point));
      }
      if (blockers(world, light, dvec3(point)) == 0) {
        // Chords of a ball's silhouette are inside it.
        ASSERT_EQ(count, 0) << "light " << i << " point " << k;
        ++lit;
        continue;
      }
      ASSERT_THAT(count, AnyOf(0, 1)) << "light " << i << " point " << k;
      ++shadowed;
      if (count == 1) continue;
      // Not of what is two hundredths inside.
      ASSERT_EQ(blockers(core, light, dvec3(point)), 0) << "light " << i << " point " << k;
      ++off;
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(shadowed, 1000);
  EXPECT_GT(eyes_in_shadow, 50);
  EXPECT_GT(off, 0);
}

TEST(EdgeList, SilhouettesAreAsExactAsTheAngleAsks) {
  const EdgeList list(make_world(ball(48)));
  const LightPoint light(0.0f, 3.0f, 0.1f, 1.0f);
  const auto edges = [&](float slack, const Vec3& eye) {
    return list.volumes(light, eye, VolumeCount::kHalved, {}, slack).edges.size();
  };
  const Vec3 far(30.0f, 1.0f, 0.0f), near(1.1f, 0.0f, 0.0f);
  EXPECT_EQ(edges(1e-5f, far), edges(0.0f, far));
  EXPECT_LT(edges(2e-3f, far), edges(0.0f, far));
  EXPECT_LT(edges(1.0f, far), edges(2e-3f, far));
  EXPECT_LT(edges(5e-3f, far), edges(5e-3f, near));
}

/// Through a hole of a closed mesh one would see what is cut off, and behind it all dark.
TEST(EdgeList, SilhouettesOfWhatIsNotConvexStayWhole) {
  Scene scene = ball(48);
  Mesh& mesh = scene.meshes[0];
  for (Vec3& p : mesh.positions) {
    if (glm::length(Vec2(p.x, p.z)) < 0.5f) p.y *= 0.5f;
  }
  const EdgeList list(make_world(scene));
  for (int i = 0; i < 20; ++i) {
    const LightPoint light(3.0f, 0.2f * static_cast<float>(i), 0.1f, 1.0f);
    EXPECT_EQ(list.volumes(light, {0, 9, 0}, VolumeCount::kHalved, {}, 1.0f).edges,
              list.volumes(light, {0, 9, 0}).edges);
  }
}

/// No edge of a fine mesh turns by much.
TEST(EdgeList, SilhouettesOfAFineRingStayWhole) {
  constexpr std::uint32_t kAround = 400, kAcross = 200;
  std::vector<Vec3> positions;
  std::vector<uvec3> triangles;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < kAcross; ++k) {
      const float u = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(kAround);
      const float v = glm::two_pi<float>() * static_cast<float>(k) / static_cast<float>(kAcross);
      const float r = 1.0f + 0.4f * std::cos(v);
      positions.emplace_back(r * std::cos(u), 0.4f * std::sin(v), r * std::sin(u));
      const std::uint32_t next = (i + 1) % kAround, up = (k + 1) % kAcross;
      const std::uint32_t a = i * kAcross + k, b = next * kAcross + k;
      const std::uint32_t c = next * kAcross + up, d = i * kAcross + up;
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  Scene scene;
  add(scene, positions, triangles);
  const EdgeList list(make_world(scene));
  const LightPoint light(3.0f, 1.0f, 0.1f, 1.0f);
  EXPECT_EQ(list.volumes(light, {0, 9, 0}, VolumeCount::kHalved, {}, 1.0f).edges,
            list.volumes(light, {0, 9, 0}).edges);
}

TEST(EdgeList, ExtrudesAClosedMeshAlongItsSilhouetteOnce) {
  const World world = make_world(tetrahedron());
  const EdgeList list(world);
  EXPECT_EQ(list.edges(), 6u);
  const Vec3 eye(5.0f, 6.0f, 7.0f);
  // From straight below one triangle is seen, from the corner's octant three.
  EXPECT_THAT(list.volumes({0.2f, 0.2f, -9.0f, 1.0f}, eye).edges, SizeIs(3));
  EXPECT_THAT(list.volumes({-9.0f, -9.0f, -9.0f, 1.0f}, eye).edges, SizeIs(3));
  EXPECT_THAT(list.volumes({-9.0f, -9.0f, 0.1f, 1.0f}, eye).edges, SizeIs(4));
  // All four planes face the light inside: it extrudes nothing, and whoever is outside sees none.
  const ShadowVolumes inside = list.volumes({0.2f, 0.2f, 0.2f, 1.0f}, eye);
  EXPECT_THAT(inside.edges, SizeIs(0));
  EXPECT_TRUE(inside.dark);
}

TEST(EdgeList, ExtrudesTheRimOfAnOpenQuadAlone) {
  const World world = make_world(open_quad());
  const EdgeList list(world);
  EXPECT_EQ(list.edges(), 5u);
  const LightPoint light(0.1f, 2.0f, 0.2f, 1.0f);
  EXPECT_THAT(list.volumes(light, {0, 1, 0}).edges, SizeIs(4));
  EXPECT_EQ(list.volumes(light, {0, 1, 0}).eye_count, 0);
  EXPECT_EQ(list.volumes(light, {0, -1, 0}).eye_count, 1);
  // On both its sides alike.
  EXPECT_EQ(list.volumes({0.1f, -2.0f, 0.2f, 1.0f}, {0, 1, 0}).eye_count, 1);
}

TEST(EdgeList, ExtrudesAnEdgeOfThreeAsOftenAsTheyDoNotCancel) {
  const World world = make_world(fan_of_three());
  const EdgeList list(world);
  EXPECT_EQ(list.edges(), 7u);
  // The shared edge: its three triangles lie on one side of it, as seen from afar at +x, but for
  // the first, which hides behind it.
  const auto times = [&](const LightPoint& light) {
    int n = 0;
    for (const VolumeEdge& edge : list.volumes(light, {9, 9, 9}).edges) {
      const Vec3 a = list.vertices()[edge.from], b = list.vertices()[edge.to];
      n += std::abs(a.z) == 1.0f && std::abs(b.z) == 1.0f ? 1 : 0;
    }
    return n;
  };
  EXPECT_EQ(times({0.0f, 9.0f, 0.1f, 1.0f}), 1);  // two to one side, one to the other
  EXPECT_EQ(times({9.0f, 0.1f, 0.0f, 1.0f}), 1);
}

TEST(EdgeList, WeldsInstancesAndTheirMirrorImages) {
  const World world = make_world(mirrored_twins());
  const EdgeList list(world);
  EXPECT_THAT(list.vertices(), SizeIs(5));  // three of eight are common
  EXPECT_EQ(list.edges(), 9u);
  EXPECT_THAT(list.casters(), SizeIs(8));
}

TEST(EdgeList, LeavesOutWhatIsBehindEverything) {
  const World world = make_world(furnished_room());
  const std::vector<Vec4> walls = find_walls(world);
  EXPECT_THAT(walls, SizeIs(6));
  EXPECT_TRUE(is_inside(walls, {0, 0, 0, 1}));
  EXPECT_FALSE(is_inside(walls, {0, 4, 0, 1}));
  EXPECT_FALSE(is_inside(walls, {0, 1, 0, 0}));  // daylight does not get in
  const EdgeList list(world, walls);
  EXPECT_THAT(list.casters(), SizeIs(10));
  // The box stands open on the floor; its silhouette is still drawn once, from straight above as
  // well: four edges of its lid.
  EXPECT_THAT(list.volumes({0.1f, 2.9f, 0.2f, 1.0f}, {2, 2, 2}).edges, SizeIs(4));
}

TEST(EdgeList, NoticesAnEyeInThePlaneOfAQuad) {
  const World world = make_world(open_quad());
  const EdgeList list(world);
  const LightPoint light(0.0f, 1.0f, 0.0f, 1.0f);
  const auto clear = [&](const Vec3& eye) {
    return is_clear_of(list, list.volumes(light, eye), light, eye, 1e-6f);
  };
  EXPECT_FALSE(clear({2.0f, -1.0f, 0.5f}));  // below the edge at x = 1
  EXPECT_TRUE(clear({2.0f, -1.001f, 0.5f}));
  EXPECT_TRUE(clear({2.0f, -1.0f, 5.0f}));  // beside it
}

}  // namespace
}  // namespace lantern
