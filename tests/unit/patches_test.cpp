// SPDX-License-Identifier: MIT
// Patches: the mesh stays conforming and keeps its area, sides that no light comes to are known,
// and interpolation keeps what is linear.
#include "lantern/radiosity/patches.h"

#include "lantern/core/error.h"
#include "lantern/core/hash.h"
#include "lantern/radiosity/interpolation.h"
#include "lantern/radiosity/t_junctions.h"
#include "lantern/trace/embree.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace lantern {
namespace {

using test::add_material;
using test::add_quad;
using test::box_room;
using test::sphere_room;

/// Sums of a few thousand areas in double precision, each from float positions made double.
constexpr double kRounding = 1e-12;

double mesh_area(const PatchMesh& mesh) {
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.size(); ++f) sum += 0.5 * glm::length(mesh.area_vector(f));
  return sum;
}

std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge_uses(const PatchMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const PatchMesh::Face& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      ++uses[std::minmax(face.vertices[k], face.vertices[(k + 1) % 3])];
    }
  }
  return uses;
}

double least_angle(const PatchMesh& mesh) {
  double least = glm::pi<double>();
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 a = mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k);
      const glm::dvec3 b = mesh.corner(f, (k + 2) % 3) - mesh.corner(f, k);
      least = std::min(least, std::acos(glm::dot(glm::normalize(a), glm::normalize(b))));
    }
  }
  return least;
}

/// Marks every n-th face, again and again.
void bisect_unevenly(PatchMesh& mesh, std::size_t rounds) {
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<bool> marked(mesh.size(), false);
    for (std::size_t f = round % 3; f < mesh.size(); f += 7) marked[f] = true;
    bisect(mesh, marked);
  }
}

struct Prepared {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;

  explicit Prepared(Scene given)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)) {}
  Patches patches(std::size_t count) const {
    return make_patches(scene, world, *tracer, PatchOptions{.count = count});
  }
};

TEST(PatchMesh, ClosedSurfacesStayClosedHoweverTheyAreBisected) {
  for (const Scene& scene : {box_room(Vec3(1, 2, 3), 0.5f, 1.0f), sphere_room(2, 0.5f, 1.0f)}) {
    PatchMesh mesh = make_patch_mesh(make_world(scene));
    bisect_unevenly(mesh, 9);
    EXPECT_GT(mesh.size(), 100u);
    // A vertex inside another face's edge would leave edges that only one face has.
    for (const auto& [edge, uses] : edge_uses(mesh)) EXPECT_EQ(uses, 2);
  }
}

TEST(PatchMesh, MoreThanTwoFacesAtAnEdgeAreBisectedTogether) {
  Scene scene;
  const MaterialId grey = add_material(scene, 0.5f, 1.0f);
  for (const Vec3 wing : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)}) {
    add_quad(scene, grey, Vec3(0.0f), Vec3(1, 0, 0), wing);
  }
  PatchMesh mesh = make_patch_mesh(make_world(scene));
  bisect_unevenly(mesh, 8);
  int shared = 0;
  for (const auto& [edge, uses] : edge_uses(mesh)) {
    const glm::dvec3 a = mesh.positions[edge.first], b = mesh.positions[edge.second];
    const bool on_hinge = a.y == 0.0 && a.z == 0.0 && b.y == 0.0 && b.z == 0.0;
    if (!on_hinge) continue;
    EXPECT_EQ(uses, 3);
    ++shared;
  }
  EXPECT_GT(shared, 1);
}

TEST(PatchMesh, BisectionKeepsAreaOrientationAndAngles) {
  PatchMesh mesh = make_patch_mesh(make_world(box_room(Vec3(1, 2, 7), 0.5f, 1.0f)));
  const PatchMesh before = mesh;
  bisect_unevenly(mesh, 10);
  EXPECT_NEAR(mesh_area(mesh) / mesh_area(before), 1.0, kRounding);
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    EXPECT_GT(glm::dot(mesh.area_vector(f), before.area_vector(mesh.faces[f].source)), 0.0);
  }
  // Rosenberg & Stenger 1975: bisecting longest edges at worst halves the least angle.
  EXPECT_GE(least_angle(mesh), 0.5 * least_angle(before) - kRounding);
}

TEST(PatchMesh, CornersKnowTheirPlaceInTheTriangleTheyComeFrom) {
  const World world = make_world(sphere_room(1, 0.5f, 1.0f));
  PatchMesh mesh = make_patch_mesh(world);
  bisect_unevenly(mesh, 6);
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    const uvec3 v = world.triangles[mesh.faces[f].source];
    const glm::dvec3 a(world.positions[v.x]), b(world.positions[v.y]), c(world.positions[v.z]);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 w = mesh.faces[f].places[static_cast<std::size_t>(k)];
      EXPECT_LT(glm::distance(a * (1.0 - w.x - w.y) + b * w.x + c * w.y, mesh.corner(f, k)),
                kRounding);
    }
  }
}

/// The floor [0, 2] x [0, 2] of two triangles on its left half and of `steps` quads on its right,
/// whose corners lie on the left half's edge: at `slant` times their place beside it.
Scene floor_with_t_junctions(int steps, float slant) {
  Scene scene;
  const MaterialId grey = add_material(scene, 0.5f, 1.0f);
  const auto seam = [&](int i) {
    const float z = 2.0f * static_cast<float>(i) / static_cast<float>(steps);
    return Vec3(1.0f + slant * z, 0.0f, z);
  };
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    test::add_mesh(scene, grey, {a, b, c, d}, {{0, 1, 2}, {0, 2, 3}});
  };
  add({0, 0, 0}, {0, 0, 2}, seam(steps), seam(0));
  for (int i = 0; i < steps; ++i) {
    add(seam(i), seam(i + 1), {2, 0, seam(i + 1).z}, {2, 0, seam(i).z});
  }
  return scene;
}

/// The lengths of edges that one face has alone.
double border_length(const PatchMesh& mesh) {
  double sum = 0.0;
  for (const auto& [edge, uses] : edge_uses(mesh)) {
    if (uses == 1) sum += glm::distance(mesh.positions[edge.first], mesh.positions[edge.second]);
  }
  return sum;
}

TEST(PatchMesh, TJunctionsOfTheInputAreClosed) {
  for (const int steps : {2, 3, 7}) {
    for (const float slant : {0.0f, 0.2f}) {  // slanted, corners miss the edge by their rounding
      const World world = make_world(floor_with_t_junctions(steps, slant));
      PatchMesh mesh = make_patch_mesh(world);
      const double area = mesh_area(mesh);
      EXPECT_GT(border_length(mesh), 11.0);
      close_t_junctions(mesh, 1e-6);
      EXPECT_EQ(mesh.size(), world.size() + static_cast<std::size_t>(steps) - 1);
      // What is left is the border of the floor.
      EXPECT_NEAR(border_length(mesh), 8.0, 1e-5);
      bisect_unevenly(mesh, 6);
      EXPECT_NEAR(border_length(mesh), 8.0, 1e-5);
      EXPECT_NEAR(mesh_area(mesh), area, 1e-6);
      for (std::size_t f = 0; f < mesh.size(); ++f) {
        const uvec3 v = world.triangles[mesh.faces[f].source];
        EXPECT_GT(mesh.area_vector(f).y, 0.0);
        for (int k = 0; k < 3; ++k) {
          const glm::dvec2 w = mesh.faces[f].places[static_cast<std::size_t>(k)];
          const glm::dvec3 place = glm::dvec3(world.positions[v.x]) * (1.0 - w.x - w.y) +
                                   glm::dvec3(world.positions[v.y]) * w.x +
                                   glm::dvec3(world.positions[v.z]) * w.y;
          EXPECT_LT(glm::distance(place, mesh.corner(f, k)), 1e-6);
        }
      }
    }
  }
}

TEST(PatchMesh, VerticesBesideEdgesAreLeftAlone) {
  for (const Vec3 away : {Vec3(0, 1e-3f, 0), Vec3(1e-3f, 0, 0)}) {
    Scene scene = floor_with_t_junctions(2, 0.0f);
    for (std::size_t m = 1; m < scene.meshes.size(); ++m) {
      for (Vec3& p : scene.meshes[m].positions) p += away;
    }
    PatchMesh mesh = make_patch_mesh(make_world(scene));
    const std::size_t before = mesh.size();
    close_t_junctions(mesh, 1e-6);
    EXPECT_EQ(mesh.size(), before);
  }
}

TEST(PatchMesh, SizeBoundsTheEdgesAndCountTheFaces) {
  PatchMesh by_size = make_patch_mesh(make_world(box_room(Vec3(1, 2, 3), 0.5f, 1.0f)));
  PatchMesh by_count = by_size;
  refine_to_size(by_size, 0.3, 100'000);
  for (std::size_t f = 0; f < by_size.size(); ++f) EXPECT_LE(by_size.longest_edge(f), 0.3);
  refine_to_count(by_count, 1000);
  EXPECT_LE(by_count.size(), 1000u);
  EXPECT_GT(by_count.size(), 950u);
  EXPECT_THROW(refine_to_size(by_count, 1e-3, 10'000), Error);
}

TEST(PatchMesh, TheHighestScoresAreRefinedAndTheCountIsKept) {
  PatchMesh mesh = make_patch_mesh(make_world(box_room(Vec3(1, 1, 1), 0.5f, 1.0f)));
  refine_to_count(mesh, 200);
  std::vector<double> scores(mesh.size());
  for (std::size_t f = 0; f < mesh.size(); ++f) scores[f] = mesh.corner(f, 0).x > 0.45 ? 1.0 : 0.0;
  const std::size_t before = mesh.size();
  refine_highest(mesh, scores, 0.5, 300);
  EXPECT_GT(mesh.size(), before);
  EXPECT_LE(mesh.size(), 300u);
}

TEST(Patches, AreasAndMeansBelongToTheSurface) {
  const Prepared prepared(box_room(Vec3(1, 2, 3), 0.3f, 2.0f));
  const Patches patches = prepared.patches(500);
  EXPECT_NEAR(std::accumulate(patches.area.begin(), patches.area.end(), 0.0), 22.0, 1e-6);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    EXPECT_NEAR(patches.reflectance[i].g, 0.3, 1e-6);
    EXPECT_NEAR(patches.emission[i].g, 2.0 * glm::pi<double>(), 1e-6);
  }
}

TEST(Patches, ATextureCountsByItsMeanOverThePatch) {
  Scene scene = box_room(Vec3(1, 1, 1), 1.0f, 1.0f);
  Texture& texture = scene.textures.emplace_back();
  texture.width = texture.height = 2;
  texture.linear = {0.2f, 0, 0, 1, 0.8f, 0, 0, 1, 0.4f, 0, 0, 1, 0.6f, 0, 0, 1};
  scene.materials[0].reflectance_texture = TextureId{};
  const Prepared prepared(std::move(scene));
  const Patches patches = prepared.patches(96);
  double sum = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i)
    sum += patches.area[i] * patches.reflectance[i].r;
  // The texture repeats, so its bilinear mean is that of the texels.
  EXPECT_NEAR(sum / 6.0, 0.5, 1e-3);
}

TEST(Patches, NoElementsWhereNoLightComes) {
  const Prepared closed(box_room(Vec3(1, 1, 1), 0.5f, 1.0f));
  const Patches inside = closed.patches(100);
  EXPECT_EQ(inside.elements(), inside.size());

  Scene scene = box_room(Vec3(1, 1, 1), 0.5f, 1.0f);
  add_quad(scene, add_material(scene, 0.5f, 0.0f), Vec3(-0.2f, 0, -0.2f), Vec3(0.4f, 0, 0),
           Vec3(0, 0.1f, 0.4f));
  const Prepared with_screen(std::move(scene));
  const Patches both = with_screen.patches(100);
  for (std::size_t i = 0; i < both.size(); ++i) {
    const bool of_screen = both.mesh.faces[i].source >= 12;
    EXPECT_EQ(both.back[i] != kNoElement, of_screen);
    if (!of_screen) continue;
    EXPECT_EQ(both.patch[both.back[i]], i);
    EXPECT_EQ(both.element_normal(both.back[i]), -both.normal[i]);
  }
}

TEST(Patches, WhatABoxStandsOnIsNotExposed) {
  Scene scene = box_room(Vec3(4, 2, 4), 0.5f, 0.0f);
  // A box without a bottom, turned, on the floor at y = -1; and the lamp that lights the room.
  const Vec3 u(0.6f, 0, 0.3f), v(-0.3f, 0, 0.6f), up(0, 0.7f, 0), foot(0.2f, -1, 0.1f);
  const MaterialId grey = add_material(scene, 0.5f, 0.0f);
  add_quad(scene, grey, foot, up, u);
  add_quad(scene, grey, foot, v, up);
  add_quad(scene, grey, foot + u + v, up, -u);
  add_quad(scene, grey, foot + u + v, -v, up);
  add_quad(scene, grey, foot + up, v, u);
  add_quad(scene, add_material(scene, 0.0f, 5.0f), Vec3(-1, 0.9f, -1), Vec3(0.5f, 0, 0),
           Vec3(0, 0, 0.5f));
  const Prepared prepared(std::move(scene));
  const Patches patches = prepared.patches(1500);
  double covered = 0.0, elsewhere = 0.0;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    const double area = patches.area[patches.patch[e]] - patches.exposed_area(e);
    const bool floor =
        patches.is_front(e) && patches.normal[e].y > 0.99 && patches.centre[e].y < -0.99;
    (floor ? covered : elsewhere) += area;
  }
  const double footprint = static_cast<double>(glm::length(glm::cross(u, v)));
  // Patches on its outline, some 30 of 0.03 m², err by about a part in 256 each way.
  EXPECT_NEAR(covered, footprint, 0.01 * footprint);
  EXPECT_EQ(elsewhere, 0.0);
}

TEST(Patches, ReflectingAllLightIsRefused) {
  Scene scene = box_room(Vec3(1, 1, 1), 1.0f, 1.0f);
  scene.materials[0].name = "mirror";
  const Prepared prepared(std::move(scene));
  try {
    prepared.patches(100);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("'mirror'"), std::string::npos) << e.what();
  }
}

TEST(Patches, EachWallOfARoomHasVerticesOfItsOwnAndSmoothNormalsShareThem) {
  const Prepared box(box_room(Vec3(1, 1, 1), 0.5f, 1.0f));
  const Patches flat = box.patches(300);
  for (std::size_t i = 0; i < flat.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (glm::dot(flat.normal[i], flat.normal[j]) > 0.5) continue;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          EXPECT_NE(flat.smooth_vertices[i][a], flat.smooth_vertices[j][b]);
        }
      }
    }
  }

  Scene ball = sphere_room(2, 0.5f, 1.0f);
  for (const Vec3& p : ball.meshes[0].positions) ball.meshes[0].normals.push_back(-p);
  const Prepared smooth(std::move(ball));
  const Patches round = smooth.patches(200);
  EXPECT_EQ(round.smooth_vertex_count, round.mesh.positions.size());
}

TEST(Interpolation, WhatIsLinearOnAWallStaysLinearToItsBorders) {
  const Prepared prepared(box_room(Vec3(1, 1, 1), 0.5f, 1.0f));
  const Patches patches = prepared.patches(600);
  const auto linear = [](const glm::dvec3& p) {
    return glm::dvec3(3.0 + p.x, 2.0 - p.y, 4.0 + p.z);
  };
  std::vector<glm::dvec3> values;
  for (std::size_t e = 0; e < patches.elements(); ++e) values.push_back(linear(patches.centre[e]));
  const VertexValues at = interpolate_to_vertices(patches, values);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 expected = linear(patches.mesh.corner(i, k));
      // The ridge takes a millionth part of the gradient or a few.
      EXPECT_LT(glm::distance(at.front[patches.smooth_vertices[i][k]], expected), 1e-5);
    }
  }
}

/// The interpolated values at a point, as each of the patches that it lies in or at the border of
/// has them.
std::vector<double> values_at(const Patches& patches, const VertexValues& at,
                              const glm::dvec3& point) {
  std::vector<double> found;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const glm::dvec3 a = patches.mesh.corner(i, 0), b = patches.mesh.corner(i, 1),
                     c = patches.mesh.corner(i, 2), n = patches.mesh.area_vector(i);
    const glm::dvec3 w(glm::dot(n, glm::cross(b - point, c - point)),
                       glm::dot(n, glm::cross(c - point, a - point)),
                       glm::dot(n, glm::cross(a - point, b - point)));
    if (std::min({w.x, w.y, w.z}) < -1e-9 * glm::dot(n, n)) continue;
    const uvec3 v = patches.smooth_vertices[i];
    found.push_back((w.x * at.front[v.x].g + w.y * at.front[v.y].g + w.z * at.front[v.z].g) /
                    glm::dot(n, n));
  }
  return found;
}

/// Values without any order, so that only shared vertices can make them meet.
std::vector<glm::dvec3> random_values(const Patches& patches) {
  std::vector<glm::dvec3> values;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    values.emplace_back(static_cast<double>(to_unit_float(hash(e))));
  }
  return values;
}

TEST(Interpolation, IsContinuousAcrossTJunctionsOfTheInput) {
  const Prepared prepared(floor_with_t_junctions(3, 0.0f));
  for (const std::size_t count : {10u, 100u}) {
    const Patches patches = prepared.patches(count);
    const VertexValues at = interpolate_to_vertices(patches, random_values(patches));
    for (int i = 0; i < 64; ++i) {
      const std::vector<double> found =
          values_at(patches, at, glm::dvec3(1.0, 0.0, (i + 0.5) / 32.0));
      EXPECT_GE(found.size(), 2u);
      for (const double value : found) EXPECT_NEAR(value, found.front(), 1e-6);
    }
  }
}

TEST(Interpolation, KeepsStepsWhereMaterialOrDirectionChanges) {
  // Three squares in a row: the second is of another material, the third rises by 3 degrees. Light
  // that is 1, 2 and 3 on them stays so up to their edges, and does not where nothing changes.
  for (const bool changes : {true, false}) {
    Scene scene;
    const MaterialId grey = add_material(scene, 0.5f, 1.0f);
    const MaterialId other = changes ? add_material(scene, 0.4f, 1.0f) : grey;
    const float rise = changes ? 0.05f : 0.0f;
    const Vec3 z(0, 0, 1);
    add_quad(scene, grey, Vec3(0, 0, 0), z, Vec3(1, 0, 0));
    add_quad(scene, other, Vec3(1, 0, 0), z, Vec3(1, 0, 0));
    add_quad(scene, other, Vec3(2, 0, 0), z, Vec3(1, rise, 0));
    const Prepared prepared(std::move(scene));
    const Patches patches = prepared.patches(100);
    std::vector<glm::dvec3> values;
    for (std::size_t e = 0; e < patches.elements(); ++e) {
      values.emplace_back(std::ceil(patches.centre[patches.patch[e]].x));
    }
    const VertexValues at = interpolate_to_vertices(patches, values);
    for (const double x : {1.0, 2.0}) {
      const std::vector<double> found = values_at(patches, at, glm::dvec3(x, 0.0, 0.3));
      const auto [low, high] = std::minmax_element(found.begin(), found.end());
      EXPECT_NEAR(*high - *low, changes ? 1.0 : 0.0, 1e-6) << x;
    }
  }
}

TEST(Interpolation, AWallKeepsItsMeanAcrossAShadowEdge) {
  const Prepared prepared(box_room(Vec3(1, 1, 1), 0.5f, 1.0f));
  const Patches patches = prepared.patches(600);
  // Light in one corner of each wall: what a fit makes of it overshoots in bends.
  std::vector<glm::dvec3> values;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    const glm::dvec3 c = patches.centre[e];
    values.emplace_back(c.x + c.y + c.z < 1.2 ? 1.0 : 0.5, 0.3 + std::exp(-8.0 * c.x * c.y), 1.0);
  }
  const VertexValues at = interpolate_to_vertices(patches, values);
  std::map<std::uint32_t, std::pair<glm::dvec3, glm::dvec3>> walls;  // of two triangles each
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const uvec3 v = patches.smooth_vertices[i];
    auto& [expected, found] = walls[patches.mesh.faces[i].source / 2];
    expected += patches.area[i] * values[i];
    found += patches.area[i] * (at.front[v.x] + at.front[v.y] + at.front[v.z]) / 3.0;
  }
  EXPECT_EQ(walls.size(), 6u);
  for (const auto& [wall, means] : walls) {
    for (int c = 0; c < 3; ++c) {
      // Equal but for rounding, as nothing had to be kept from going below zero.
      EXPECT_NEAR(means.second[c] / means.first[c], 1.0, 1e-12) << wall;
    }
  }
}

}  // namespace
}  // namespace lantern
