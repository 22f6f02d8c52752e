// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube.h"

#include "lantern/core/error.h"
#include "lantern/core/hash.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

namespace lantern {
namespace {

constexpr double kPi64 = std::numbers::pi;

// --- delta form factors
// ---------------------------------------------------------------------------

/// Form factor from a point to the rectangle [0, a] x [0, b] at distance 1 that is parallel to its
/// surface, one corner above the point. [Howell's catalogue, B-3]
double parallel_corner(double a, double b) {
  const double ra = std::sqrt(1.0 + a * a), rb = std::sqrt(1.0 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2.0 * kPi64);
}

/// The same to a rectangle at distance 1 that stands on the surface: width a, height b, one lower
/// corner at the foot of the perpendicular from the point. [Howell's catalogue, B-5]
double perpendicular_corner(double a, double b) {
  const double rb = std::sqrt(1.0 + b * b);
  return (std::atan(a) - std::atan(a / rb) / rb) / (2.0 * kPi64);
}

/// Of a rectangle between two corners, by the signed parts that share the corner (0, 0).
template <typename Corner>
double between(const Corner& corner, double a0, double a1, double b0, double b1) {
  return corner(a1, b1) - corner(a0, b1) - corner(a1, b0) + corner(a0, b0);
}

double closed_form_of_pixel(const Vec3& direction, double step) {
  const glm::dvec3 d(direction);
  const auto around = [&](const auto& corner, double a, double b) {
    return between(corner, a - 0.5 * step, a + 0.5 * step, b - 0.5 * step, b + 0.5 * step);
  };
  if (d.z == 1.0) return around(parallel_corner, d.x, d.y);
  return around(perpendicular_corner, std::abs(d.x) == 1.0 ? d.y : d.x, d.z);
}

TEST(Hemicube, DeltaFormFactorsAreTheClosedFormsOfTheirPixels) {
  for (const int resolution : {8, 64, 256}) {
    const Hemicube cube(resolution);
    ASSERT_EQ(cube.size(), 3u * static_cast<std::size_t>(resolution * resolution));
    const double step = 2.0 / resolution;
    double sum = 0.0, exact_sum = 0.0;
    for (std::size_t i = 0; i < cube.size(); ++i) {
      const double exact = closed_form_of_pixel(cube.direction(i), step);
      // The midpoint rule errs by step²/24 times the second derivatives, at most 16 times the value
      // on a side and 8 times on the top; the rest is for making the sum 1.
      EXPECT_NEAR(cube.delta()[i], exact, step * step * exact + 1e-15) << i;
      sum += cube.delta()[i];
      exact_sum += exact;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(exact_sum, 1.0, 1e-6);  // directions are floats
  }
}

TEST(Hemicube, DiscretisationFallsWithTheNumberOfPixels) {
  double coarse = Hemicube(16).discretisation();
  for (const int resolution : {32, 64, 128}) {
    const double fine = Hemicube(resolution).discretisation();
    // The midpoint rule errs like the square of the step.
    EXPECT_NEAR(coarse / fine, 4.0, 0.05) << resolution;
    coarse = fine;
  }
}

TEST(Hemicube, RefusesResolutionsThatPacketsDoNotFill) {
  for (const int resolution : {-8, 0, 4, 7, 12, 63}) EXPECT_THROW(Hemicube{resolution}, Error);
}

TEST(Hemicube, PixelsCoverTheHemisphere) {
  // ∫ cos θ ω dω over the hemisphere is (0, 0, 2π/3): by the deltas, whose measure is cos θ/π.
  const Hemicube cube(64);
  glm::dvec3 mean(0.0);
  for (std::size_t i = 0; i < cube.size(); ++i) {
    mean += cube.delta()[i] * glm::normalize(glm::dvec3(cube.direction(i)));
  }
  EXPECT_NEAR(mean.x, 0.0, 1e-9);
  EXPECT_NEAR(mean.y, 0.0, 1e-9);
  EXPECT_NEAR(mean.z, 2.0 / 3.0, 2e-4);  // as the sum of the deltas errs, 1.3e-4
}

// --- form factors to polygons
// ---------------------------------------------------------------------------

struct Seen {
  const char* name;
  Vec3 corner, u, v;
};

/// Form factor that the hemicube at the origin, normal +z, finds for the one quad of the scene.
double hemicube_form_factor(const Hemicube& cube, const Tracer& tracer, float angle,
                            Vec2 shift = Vec2(0.0f)) {
  HemicubeView view(Vec3(0.0f), Vec3(0, 0, 1), angle, 1.0f);
  view.shift = shift;
  std::array<Hit, kPacket> hits;
  double sum = 0.0;
  for (std::size_t p = 0; p < cube.packets(); ++p) {
    cube.draw(tracer, view, p, hits.data());
    for (std::size_t i = 0; i < kPacket; ++i) {
      if (hits[i]) sum += cube.delta()[p * kPacket + i];
    }
  }
  return sum;
}

TEST(Hemicube, TurnedAndShiftedItFindsALampSmallerThanAPixelInTheMean) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(0.4f, 0.0f, 1.0f),
                 Vec3(0.1f, 0, 0), Vec3(0, 0.1f, 0));
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const double exact = between(parallel_corner, 0.4, 0.5, 0.0, 0.1);
  const Hemicube cube(16);  // of pixels an eighth wide
  constexpr int kViews = 4000;
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < kViews; ++i) {
    const auto unit = [i](std::uint64_t k) { return to_unit_float(hash(i, k)); };
    const double found =
        hemicube_form_factor(cube, *tracer, 2.0f * kPi * unit(0), Vec2(unit(1), unit(2)) - 0.5f);
    sum += found / kViews;
    squares += found * found / kViews;
  }
  // By turning alone the mean is 10 % off, however many turns there are.
  const double error = std::sqrt((squares - sum * sum) / kViews);
  EXPECT_NEAR(sum, exact, 4.0 * error);
  EXPECT_LT(error, 0.02 * exact);
}

TEST(Hemicube, FormFactorsErrByNoMoreThanTheirBorderPixels) {
  const std::array<Seen, 4> quads{{{"parallel", {-0.5f, -0.4f, 1.0f}, {1, 0, 0}, {0, 1.1f, 0}},
                                   {"standing", {1.0f, -0.5f, 0.0f}, {0, 1, 0}, {0, 0, 0.8f}},
                                   {"askew", {0.2f, 0.3f, 0.7f}, {0.9f, 0.1f, 0.4f}, {-0.2f, 1, 0}},
                                   {"across faces", {-3, -2, 0.9f}, {6, 0.5f, 0}, {0, 4, 0.3f}}}};
  for (const Seen& quad : quads) {
    Scene scene;
    test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), quad.corner, quad.u, quad.v);
    const World world = make_world(scene);
    const auto tracer = make_embree_tracer(scene, world);
    const std::array<glm::dvec3, 4> corners{
        glm::dvec3(quad.corner), glm::dvec3(quad.corner + quad.u),
        glm::dvec3(quad.corner + quad.u + quad.v), glm::dvec3(quad.corner + quad.v)};
    const double exact = test::polygon_irradiance(corners, {0, 0, 1}, 1.0) / kPi64;
    double coarse = 0.0;
    for (const int resolution : {16, 64, 256}) {
      const Hemicube cube(resolution);
      double worst = 0.0, square = 0.0;
      constexpr int kTurns = 24;
      for (int turn = 0; turn < kTurns; ++turn) {
        const auto angle = static_cast<float>(turn * 2.0 * kPi64 / kTurns + 0.1);
        const double error = hemicube_form_factor(cube, *tracer, angle) - exact;
        worst = std::max(worst, std::abs(error));
        square += error * error / kTurns;
      }
      // Pixel centres find a line to half a pixel in each column (or row, if it is steep) of the
      // faces it crosses. None of the four edges crosses more than three, and no pixel is worth
      // more than the middle of the top.
      const double step = 2.0 / resolution;
      const double border = 4.0 * 3.0 * resolution * 0.5 * step * step / kPi64;
      EXPECT_LT(worst, border + std::abs(cube.discretisation())) << quad.name << " " << resolution;
      const double fine = std::sqrt(square);
      // Four times the resolution: a line's pixels err independently of each other at best (1/8)
      // and all alike at worst (1/4).
      if (coarse > 0.0) {
        EXPECT_LT(fine, 0.4 * coarse) << quad.name << " " << resolution;
      }
      coarse = fine;
    }
    EXPECT_LT(coarse, 0.002 * exact) << quad.name;
  }
}

TEST(Hemicube, MeansOverARectangleAreItsFormFactors) {
  // Unit squares: opposite at distance 1 and at right angles along a common edge.
  // [Howell's catalogue, C-11 and C-14]
  const double opposite =
      2.0 / kPi64 *
      (std::log(std::sqrt(4.0 / 3.0)) + 2.0 * std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0)) -
       2.0 * std::atan(1.0));
  const double adjacent = (2.0 * std::atan(1.0) - std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0)) +
                           0.25 * std::log(0.75)) /
                          kPi64;
  const auto mean = [](const Vec3& corner, const Vec3& u, const Vec3& v) {
    Scene scene;
    test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), corner, u, v);
    const World world = make_world(scene);
    const auto tracer = make_embree_tracer(scene, world);
    const Hemicube cube(64);
    constexpr int kPlaces = 24;
    double sum = 0.0;
    std::array<Hit, kPacket> hits;
    for (int i = 0; i < kPlaces * kPlaces; ++i) {
      const Vec3 place((static_cast<float>(i % kPlaces) + 0.5f) / kPlaces,
                       (static_cast<float>(i / kPlaces) + 0.5f) / kPlaces, 0.0f);
      const HemicubeView view(place, Vec3(0, 0, 1), static_cast<float>(i), 1.0f);
      for (std::size_t p = 0; p < cube.packets(); ++p) {
        cube.draw(*tracer, view, p, hits.data());
        for (std::size_t k = 0; k < kPacket; ++k) {
          if (hits[k]) sum += cube.delta()[p * kPacket + k];
        }
      }
    }
    return sum / (kPlaces * kPlaces);
  };
  // Midpoints of 1/24 under kernels of unit curvature err by less than 1e-3; near a common edge
  // the kernel bends more.
  EXPECT_NEAR(mean({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), opposite, 1e-3);
  EXPECT_NEAR(mean({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), adjacent, 2e-3);
}

}  // namespace
}  // namespace lantern
