// SPDX-License-Identifier: MIT
#include "lantern/radiosity/progressive.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/radiosity/direct_light.h"
#include "lantern/radiosity/hemicube_matrix.h"
#include "lantern/radiosity/hemicube_rows.h"
#include "lantern/radiosity/solve.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace lantern {
namespace {

constexpr double kPi64 = std::numbers::pi;

/// A scene cut into patches.
struct Patched {
  test::Stage stage;
  Patches patches;

  Patched(Scene scene, std::size_t count)
      : stage(std::move(scene)),
        patches(make_patches(stage.scene, stage.world, *stage.tracer, {.count = count})) {}

  HemicubeRows rows(const HemicubeOptions& options = {}) const {
    return {stage.world, *stage.tracer, patches, options};
  }
  ProgressiveRadiosity progressive(const ProgressiveOptions& options = {},
                                   std::span<const glm::dvec3> external = {}) const {
    return {stage.world, *stage.tracer, patches, options, external};
  }
};

/// A room of two colours with a lamp on its ceiling and a box that stands on its floor; `open`
/// leaves one wall out.
Scene furnished_room(bool open) {
  Scene scene;
  const MaterialId white = test::add_material(scene, 0.7f, 0.0f);
  const MaterialId red = test::add_material(scene, 0.0f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.1f, 5.0f);
  scene.materials[index(red)].reflectance = Rgb(0.6f, 0.1f, 0.05f);
  const Vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  test::add_quad(scene, white, Vec3(0), z, x);
  test::add_quad(scene, white, y, x, z);
  test::add_quad(scene, red, Vec3(0), y, z);
  test::add_quad(scene, white, x, z, y);
  test::add_quad(scene, white, Vec3(0), x, y);
  if (!open) test::add_quad(scene, white, z, y, x);
  test::add_quad(scene, lamp, {0.8f, 1.99f, 0.8f}, {0.4f, 0, 0}, {0, 0, 0.4f});
  const Vec3 low(1.1f, 0, 0.3f), a(0.5f, 0, 0.1f), b(-0.1f, 0, 0.5f), up(0, 0.8f, 0);
  test::add_quad(scene, white, low + up, b, a);
  test::add_quad(scene, white, low, up, a);
  test::add_quad(scene, white, low, b, up);
  test::add_quad(scene, white, low + b, a, up);
  test::add_quad(scene, white, low + a, up, b);
  return scene;
}

double row_sum(const FormFactorRow& row) {
  double sum = row.escaped;
  for (const double factor : row.factors) sum += factor;
  return sum;
}

// --- places on triangles
// --------------------------------------------------------------------------

TEST(PatchLocator, FindsThePatchOfEveryPlace) {
  for (const std::size_t count : {1, 40, 700, 5000}) {
    const Patched room(furnished_room(false), count);
    const PatchMesh& mesh = room.patches.mesh;
    const PatchLocator locator(mesh, room.stage.world.size());
    for (std::uint32_t f = 0; f < mesh.size(); ++f) {
      const auto& p = mesh.faces[f].places;
      const auto at = [&](double a, double b) {
        return locator.at(mesh.faces[f].source, Vec2(p[0] + a * (p[1] - p[0]) + b * (p[2] - p[0])));
      };
      // Everywhere but within the rounding of float of a side.
      for (int i = 0; i < 16; ++i) {
        double a = 0.002 + 0.996 * static_cast<double>(to_unit_float(hash(f, i, 0)));
        double b = 0.002 + 0.996 * static_cast<double>(to_unit_float(hash(f, i, 1)));
        if (a + b > 1.0) std::tie(a, b) = std::pair(1.0 - a, 1.0 - b);
        if (a + b > 0.998) continue;
        EXPECT_EQ(at(a, b), f) << a << " " << b;
      }
    }
    // Corners and places that rounding took outside have a patch of their triangle.
    for (std::uint32_t t = 0; t < room.stage.world.size(); ++t) {
      for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.5f, 0.5f),
                            Vec2(-1e-7f, 0.3f), Vec2(0.3000001f, 0.7f), Vec2(1.0000001f, -1e-7f)}) {
        EXPECT_EQ(mesh.faces[locator.at(t, uv)].source, t);
      }
    }
  }
}

// --- rows
// -----------------------------------------------------------------------------------------

TEST(HemicubeRows, SumToOneWithWhatEscapes) {
  for (const bool open : {false, true}) {
    const Patched room(furnished_room(open), 600);
    HemicubeRows rows = room.rows({.resolution = 32});
    std::vector<FormFactorRow> all(room.patches.elements());
    rows.from_centres(0, all);
    double escaped = 0.0;
    for (std::size_t e = 0; e < all.size(); ++e) {
      EXPECT_NEAR(row_sum(all[e]), 1.0, 1e-12);
      EXPECT_EQ(std::count(all[e].elements.begin(), all[e].elements.end(), e), 0) << e;
      if (room.patches.exposed[e] > 0.0) escaped = std::max(escaped, all[e].escaped);
    }
    if (open) {
      EXPECT_GT(escaped, 0.3);
    } else {
      // Not a ray slips between two patches or off the lamp's and the box's feet.
      EXPECT_EQ(escaped, 0.0);
    }
  }
}

TEST(HemicubeRows, OfARoomAreReciprocal) {
  // From wall to wall of a box, A_i F_ij = A_j F_ji for whole walls: what is left is the error of
  // hemicubes at centres.
  const Patched room(test::box_room({2.0f, 1.5f, 2.5f}, 0.5f, 1.0f), 1000);
  std::vector<FormFactorRow> all(room.patches.size());
  room.rows().from_centres(0, all);
  const auto wall = [&](std::size_t e) {
    const glm::dvec3 n = room.patches.normal[e];
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(n[axis]) > 0.5)
        return static_cast<std::size_t>(2 * axis + (n[axis] > 0 ? 1 : 0));
    }
    return std::size_t{0};
  };
  std::array<std::array<double, 6>, 6> exchange{};
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (std::size_t i = 0; i < all[e].elements.size(); ++i) {
      exchange[wall(e)][wall(all[e].elements[i])] += room.patches.area[e] * all[e].factors[i];
    }
  }
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(exchange[i][i], 0.0);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(exchange[i][j] / exchange[j][i], 1.0, 0.01) << i << " " << j;
    }
  }
}

TEST(HemicubeRows, StandWhereTheirElementIsNotCovered) {
  // Two patches make the floor, and on the centre of each stands a solid.
  Scene scene = test::box_room(Vec3(2.0f), 0.5f, 1.0f);
  const MaterialId white = test::add_material(scene, 0.5f, 0.0f);
  for (const Vec3 foot : {Vec3(-0.33f, -1, 0.33f), Vec3(0.33f, -1, -0.33f)}) {
    const Vec3 a(0.3f, 0, 0), b(0, 0, 0.3f), up(0, 0.3f, 0), low = foot - 0.5f * (a + b);
    const Vec3 top = low + up;
    test::add_mesh(scene, white,
                   {low, low + a, low + a + b, low + b, top, top + a, top + a + b, top + b},
                   {{0, 1, 2},
                    {0, 2, 3},
                    {4, 6, 5},
                    {4, 7, 6},
                    {0, 5, 1},
                    {0, 4, 5},
                    {1, 6, 2},
                    {1, 5, 6},
                    {2, 7, 3},
                    {2, 6, 7},
                    {3, 4, 0},
                    {3, 7, 4}});
  }
  const Patched room(std::move(scene), 1);
  const HemicubeView centre(Vec3(room.patches.centre[2]), Vec3(0, 1, 0), 0.0f,
                            room.stage.world.coordinate_scale());
  const Hit above =
      room.stage.tracer->closest({.origin = centre.origin, .direction = Vec3(0, 1, 0)});
  ASSERT_LT(above.distance, 0.4f) << "the centre is under the solid";

  std::vector<FormFactorRow> walls(12);
  room.rows().from_centres(0, walls);
  for (const FormFactorRow& row : walls) {
    EXPECT_EQ(row.escaped, 0.0);
    EXPECT_NEAR(row_sum(row), 1.0, 1e-12);
    EXPECT_GE(row.elements.size(), 10u);
  }
}

// --- the matrix
// ------------------------------------------------------------------------------------

/// Gathered by the matrix that hemicubes find.
std::vector<glm::dvec3> gathered(const Patched& room, const FormFactors& factors) {
  const StopFlag never{false};
  const std::vector<glm::dvec3> none(room.patches.elements(), glm::dvec3(0.0));
  return solve_by_gauss_seidel(room.patches, factors, none, {}, never).irradiance;
}

FormFactors matrix_by_hemicubes(const Patched& room, int resolution) {
  const StopFlag never{false};
  return hemicube_matrix(room.stage.world, *room.stage.tracer, room.patches,
                         {.resolution = resolution}, never)
      .factors;
}

TEST(HemicubeMatrix, FurnaceIsEmissionOverOneLessReflectance) {
  for (const float reflectance : {0.0f, 0.5f, 0.9f}) {
    constexpr float kEmission = 2.0f;
    const Patched room(test::box_room({2.0f, 1.5f, 2.5f}, reflectance, kEmission), 200);
    const FormFactors factors = matrix_by_hemicubes(room, 32);
    const RowSums sums = row_sums(room.patches, factors);
    // Rows add up to 1 but for the rounding of their few hundred floats.
    EXPECT_NEAR(sums.least, 1.0, 1e-6);
    EXPECT_NEAR(sums.most, 1.0, 1e-6);
    const double expected =
        kPi64 * static_cast<double>(kEmission) / (1.0 - static_cast<double>(reflectance));
    for (const glm::dvec3& irradiance : gathered(room, factors)) {
      // Then so does every patch, whatever its factors are, as if reflected 1/(1 - a) times.
      EXPECT_NEAR(irradiance.g, expected, 1e-5 * expected);
    }
  }
}

TEST(HemicubeMatrix, ReciprocityErrorFallsWithTheResolution) {
  const Patched room(test::box_room(Vec3(1.0f), 0.5f, 1.0f), 300);
  const double coarse = reciprocity_error(room.patches, matrix_by_hemicubes(room, 16));
  const double fine = reciprocity_error(room.patches, matrix_by_hemicubes(room, 128));
  EXPECT_LT(fine, 0.5 * coarse);
  // What stays are centres in the place of patches, where patches meet at right angles.
  EXPECT_LT(fine, 0.2);
  EXPECT_GT(fine, 0.0);
}

TEST(HemicubeMatrix, HalfShadowsAreSeenFromManyPoints) {
  const Patched room(furnished_room(false), 400);
  const Patches& patches = room.patches;
  const StopFlag never{false};
  const HemicubeOptions options{.resolution = 64};
  const FormFactors many =
      hemicube_matrix(room.stage.world, *room.stage.tracer, patches, options, never).factors;
  std::vector<FormFactorRow> centres(patches.elements());
  room.rows(options).from_centres(0, centres);
  const FormFactors sampled(room.stage.world, *room.stage.tracer, patches, never);
  const std::vector<DirectLight> direct =
      direct_light(room.stage.world, *room.stage.tracer, patches);
  double error_of_many = 0.0, error_of_centres = 0.0, guessed = 0.0, total = 0.0;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    double by_many = 0.0, by_rays = 0.0, from_centre = 0.0;
    const auto emits = [&](std::size_t s) { return patches.emission[s] != glm::dvec3(0.0); };
    for (std::size_t s = 0; s < patches.elements(); ++s) {
      if (!emits(s)) continue;
      by_many += static_cast<double>(many.row(e)[s]);
      by_rays += static_cast<double>(sampled.row(e)[s]);
    }
    for (std::size_t k = 0; k < centres[e].elements.size(); ++k) {
      if (emits(centres[e].elements[k])) from_centre += centres[e].factors[k];
    }
    const double area = patches.exposed_area(e);
    const bool half = direct[e].seen > 0.0 && direct[e].seen < 0.9;
    if (half) error_of_many += area * (by_many - by_rays) * (by_many - by_rays);
    if (half) error_of_centres += area * (from_centre - by_rays) * (from_centre - by_rays);
    guessed += area * direct[e].form_factor;
    total += area * by_rays;
    // All of the lamp is seen only by what it lights.
    if (by_rays == 0.0) {
      EXPECT_LT(direct[e].seen, 1.0) << e;
    }
  }
  // Sixteen rays for each element in half shadow and centres of areas for the rest: 0.7 % off.
  EXPECT_NEAR(guessed, total, 0.02 * total);
  // Squares: 0.065, of it the error of the rays, 1/32, and of the pixels. The same number of points
  // anywhere on the elements are worse than centres.
  EXPECT_LT(error_of_many, 0.15 * error_of_centres);
}

TEST(HemicubeMatrix, StoppedEarlyTheRestIsBlack) {
  const Patched room(test::box_room(Vec3(1.0f), 0.5f, 1.0f), 300);
  const StopFlag at_once{true};
  const FormFactors factors =
      hemicube_matrix(room.stage.world, *room.stage.tracer, room.patches, {}, at_once).factors;
  EXPECT_EQ(row_sums(room.patches, factors).most, 0.0);
}

// --- shooting
// -------------------------------------------------------------------------------------

TEST(Progressive, FurnaceIsEmissionOverOneLessReflectance) {
  for (const float reflectance : {0.2f, 0.5f, 0.9f}) {
    constexpr float kEmission = 2.0f;
    const Patched room(test::box_room({2.0f, 1.5f, 2.5f}, reflectance, kEmission), 300);
    const double expected =
        kPi64 * static_cast<double>(kEmission) / (1.0 - static_cast<double>(reflectance));
    ProgressiveRadiosity solution = room.progressive({.cutoff = 1e-4});
    // Before the first shot the ambient term is all there is, and exact: the room is uniform.
    EXPECT_NEAR(solution.ambient().g, expected, 1e-6 * expected);
    while (solution.shoot()) {
    }
    const std::vector<glm::dvec3> irradiance = solution.irradiance();
    double mean = 0.0, area = 0.0, square = 0.0;
    for (std::size_t e = 0; e < irradiance.size(); ++e) {
      const double a = room.patches.exposed_area(e), here = irradiance[e].g / expected - 1.0;
      mean += a * here;
      square += a * here * here;
      area += a;
    }
    // What is unshot is missing, with its reflections. Flux is conserved, so nothing else can be.
    const double missing = 1e-4 / (1.0 - static_cast<double>(reflectance));
    EXPECT_NEAR(mean / area, 0.0, missing) << reflectance;
    // Emission alone finds every element by some 2000 pixels, 2 % apart; over the room's edges,
    // where the three points on an element that it comes from are few, more.
    EXPECT_LT(std::sqrt(square / area), 0.045) << reflectance;
  }
}

TEST(Progressive, FluxIsConservedAndTheUnshotFallsWithEveryShot) {
  for (const bool open : {false, true}) {
    const Patched room(furnished_room(open), 800);
    ProgressiveRadiosity solution = room.progressive({.cutoff = 1e-3});
    double unshot = solution.unshot_share();
    EXPECT_NEAR(unshot, 1.0, 1e-12);
    double worst = 0.0;
    while (solution.shoot()) {
      ASSERT_LT(solution.unshot_share(), unshot) << "shot " << solution.shots();
      unshot = solution.unshot_share();
      worst = std::max(worst, solution.balance().error());
    }
    EXPECT_LT(worst, 1e-10);  // roundings of a few thousand sums; 1e-6 is asked for
    EXPECT_LE(unshot, 1e-3);
    const FluxBalance balance = solution.balance();
    // A lamp of 0.4 x 0.4 that radiates 5, one-sided.
    EXPECT_NEAR(balance.emitted.r, 5.0 * kPi64 * 0.16, 1e-5);
    if (open) {
      EXPECT_GT(balance.escaped.g, 0.1 * balance.emitted.g);
    } else {
      EXPECT_EQ(balance.escaped.g, 0.0);
    }
    EXPECT_GT(balance.absorbed.g, balance.absorbed.r);  // by the red wall
  }
}

TEST(Progressive, TakesTheIrradianceOfLightsThatAreNoPatches) {
  // A room that is lit evenly from nowhere: E/(1-a) again, E the given irradiance.
  Scene scene = test::box_room({2.0f, 1.5f, 2.5f}, 0.5f, 0.0f);
  scene.lights.emplace_back();  // else patches know that no light can come to them
  const Patched room(std::move(scene), 300);
  const std::vector<glm::dvec3> direct(room.patches.elements(), glm::dvec3(1.0, 2.0, 4.0));
  ProgressiveRadiosity solution = room.progressive({.cutoff = 1e-4}, direct);
  while (solution.shoot()) {
  }
  glm::dvec3 mean(0.0);
  double area = 0.0;
  const std::vector<glm::dvec3> irradiance = solution.irradiance();
  for (std::size_t e = 0; e < irradiance.size(); ++e) {
    mean += irradiance[e] * room.patches.area[e];
    area += room.patches.area[e];
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / area / (2.0 * direct[0][c]), 1.0, 2e-4);
  EXPECT_LT(solution.balance().error(), 1e-10);
}

TEST(Progressive, DarkSceneHasNothingToShoot) {
  const Patched room(test::box_room(Vec3(1.0f), 0.5f, 0.0f), 100);
  ProgressiveRadiosity solution = room.progressive({.cutoff = 0.0});
  EXPECT_FALSE(solution.shoot());
  EXPECT_EQ(solution.unshot_share(), 0.0);
  EXPECT_EQ(solution.ambient(), glm::dvec3(0.0));
  EXPECT_EQ(solution.balance().error(), 0.0);
}

/// A black floor under a lamp that is a single quad of two patches.
Scene lamp_over_floor() {
  Scene scene;
  const MaterialId floor = test::add_material(scene, 0.0f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.0f, 3.0f);
  test::add_quad(scene, floor, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  test::add_quad(scene, lamp, {-0.5f, 1.2f, -0.5f}, {1, 0, 0}, {0, 0, 1});
  return scene;
}

TEST(Progressive, BigEmitterLightsTheFloorAsTheClosedFormSays) {
  const Patched place(lamp_over_floor(), 2000);
  ProgressiveRadiosity solution = place.progressive({.cutoff = 1e-6});
  while (solution.shoot()) {
  }
  const std::vector<glm::dvec3> irradiance = solution.irradiance();
  double square = 0.0, mean = 0.0;
  std::size_t count = 0;
  for (std::size_t e = 0; e < place.patches.size(); ++e) {
    const glm::dvec3 centre = place.patches.centre[e];
    if (std::abs(centre.y) > 0.1) continue;
    const auto corner = [&](double x, double z) { return glm::dvec3(x, 1.2, z) - centre; };
    const std::array<glm::dvec3, 4> lamp{corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5),
                                         corner(-0.5, 0.5)};
    const double exact = test::polygon_irradiance(lamp, {0, 1, 0}, 3.0);
    const double error = irradiance[e].g / exact - 1.0;
    square += error * error;
    mean += error;
    ++count;
  }
  ASSERT_GT(count, 500u);
  // All elements together get 2000 times 2048 pixels, those of the floor's corners some hundred of
  // them each: errors of 2 % in the mean, of 10 % there.
  EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 0.03);
  // The lamp's points are spread over it evenly, 2000 errors of 2 % even out.
  EXPECT_NEAR(mean / static_cast<double>(count), 0.0, 0.002);
}

TEST(Progressive, SameBitsOnAnyNumberOfThreads) {
  const Patched room(furnished_room(true), 500);
  std::vector<std::vector<glm::dvec3>> results;
  for (const int threads : {1, 2, 7}) {
    ThreadScope scope(threads);
    scope.run([&] {
      ProgressiveRadiosity solution = room.progressive({.hemicube = {.resolution = 32}});
      for (int shot = 0; shot < 200; ++shot) ASSERT_TRUE(solution.shoot());
      results.push_back(solution.irradiance());
      results.back().push_back(solution.ambient());
      std::vector<FormFactorRow> rows(40);
      room.rows().from_centres(7, rows);
      for (const FormFactorRow& row : rows) {
        for (const double factor : row.factors) results.back().emplace_back(factor);
      }
    });
  }
  for (const auto& result : results) {
    ASSERT_EQ(result.size(), results.front().size());
    EXPECT_EQ(
        std::memcmp(result.data(), results.front().data(), result.size() * sizeof(glm::dvec3)), 0);
  }
}

TEST(Progressive, SeedMovesTheHemicubes) {
  const Patched room(furnished_room(true), 500);
  const auto irradiance = [&](std::uint64_t seed) {
    ProgressiveRadiosity solution =
        room.progressive({.hemicube = {.resolution = 32, .seed = seed}});
    for (int shot = 0; shot < 20; ++shot) solution.shoot();
    return solution.irradiance();
  };
  EXPECT_NE(irradiance(0), irradiance(1));
}

}  // namespace
}  // namespace lantern
