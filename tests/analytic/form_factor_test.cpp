// SPDX-License-Identifier: MIT
// Form factors against the closed forms of Howell's catalogue (A Catalog of Radiation Heat Transfer
// Configuration Factors, 3rd edition), and the laws of the assembled matrix.
#include "lantern/radiosity/exchange.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/polygon_factor.h"
#include "lantern/radiosity/random.h"
#include "lantern/trace/embree.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lantern {
namespace {

using glm::dvec3;

constexpr double kPiD = glm::pi<double>();
/// What the issue asks of closed forms.
constexpr double kAnalytic = 1e-6;

Polygon polygon(std::initializer_list<dvec3> corners) {
  return Polygon(std::span(corners.begin(), corners.size()));
}

/// x in [x1, x2], y in [y1, y2] at height z; the front up or down.
Polygon level(double x1, double x2, double y1, double y2, double z, bool up) {
  return up ? polygon({{x1, y1, z}, {x2, y1, z}, {x2, y2, z}, {x1, y2, z}})
            : polygon({{x1, y1, z}, {x1, y2, z}, {x2, y2, z}, {x2, y1, z}});
}

/// y in [y1, y2], z in [z1, z2] at x = 0, the front towards +x.
Polygon upright(double y1, double y2, double z1, double z2) {
  return polygon({{0, y1, z1}, {0, y2, z1}, {0, y2, z2}, {0, y1, z2}});
}

/// C-11: identical, parallel, directly opposed rectangles a by b at distance c.
double howell_c11(double a, double b, double c) {
  const double x = a / c, y = b / c, x1 = std::sqrt(1 + x * x), y1 = std::sqrt(1 + y * y);
  return 2.0 / (kPiD * x * y) *
         (std::log(x1 * y1 / std::sqrt(1 + x * x + y * y)) + x * y1 * std::atan(x / y1) +
          y * x1 * std::atan(y / x1) - x * std::atan(x) - y * std::atan(y));
}

/// C-14: rectangles at a right angle with a common edge of length l; from the one of width w to the
/// one of height h.
double howell_c14(double l, double w_metres, double h_metres) {
  const double w = w_metres / l, h = h_metres / l, w2 = w * w, h2 = h * h, hw = std::sqrt(h2 + w2);
  const double logs = std::log((1 + w2) * (1 + h2) / (1 + w2 + h2)) +
                      w2 * std::log(w2 * (1 + w2 + h2) / ((1 + w2) * (w2 + h2))) +
                      h2 * std::log(h2 * (1 + h2 + w2) / ((1 + h2) * (h2 + w2)));
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - hw * std::atan(1 / hw) + 0.25 * logs) /
         (kPiD * w);
}

/// Sum over the corners of two rectangles of a function of corners, signs alternating.
template <typename Function>
double over_corners(const double (&x)[2], const double (&y)[2], const double (&eta)[2],
                    const double (&xi)[2], Function g) {
  double sum = 0.0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) {
          sum += ((i + j + k + l) % 2 == 0 ? 1.0 : -1.0) * g(x[i], y[j], eta[k], xi[l]);
        }
      }
    }
  }
  return sum;
}

/// C-13: parallel rectangles of any sizes at distance z, their sides parallel.
double howell_c13(const double (&x)[2], const double (&y)[2], const double (&xi)[2],
                  const double (&eta)[2], double z) {
  const auto g = [z](double xx, double yy, double e, double s) {
    const double u = xx - s, v = yy - e, p = std::sqrt(u * u + z * z), q = std::sqrt(v * v + z * z);
    return (v * p * std::atan(v / p) + u * q * std::atan(u / q) -
            0.5 * z * z * std::log(u * u + v * v + z * z)) /
           (2.0 * kPiD);
  };
  return over_corners(x, y, eta, xi, g) / ((x[1] - x[0]) * (y[1] - y[0]));
}

/// C-15: rectangles at a right angle of any sizes, their sides parallel: the first x by y, the
/// other of heights xi above the first's plane and y-range eta, at x = 0.
double howell_c15(const double (&x)[2], const double (&y)[2], const double (&xi)[2],
                  const double (&eta)[2]) {
  const auto g = [](double xx, double yy, double e, double s) {
    const double c = std::sqrt(xx * xx + s * s), d = yy - e;
    const double angle = c > 0.0 ? d * c * std::atan(d / c) : 0.0;
    const double square = c * c + d * d;
    const double log = square > 0.0 ? 0.25 * (c * c - d * d) * std::log(square) : 0.0;
    return (angle - log) / (2.0 * kPiD);
  };
  return over_corners(x, y, eta, xi, g) / ((x[1] - x[0]) * (y[1] - y[0]));
}

/// C-41: coaxial parallel discs of radii r1 and r2 at distance h, from the first.
double howell_c41(double r1, double r2, double h) {
  const double a = r1 / h, b = r2 / h, x = 1 + (1 + b * b) / (a * a);
  return 0.5 * (x - std::sqrt(x * x - 4 * (b / a) * (b / a)));
}

/// Exchange of two discs as regular polygons of n sides: n times that of one sector of the first.
double discs(double r1, double r2, double h, int n) {
  const auto corner = [n](double r, int k, double z) {
    const double angle = 2.0 * kPiD * k / n;
    return dvec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  const Polygon sector = polygon({{0, 0, 0}, corner(r1, 0, 0), corner(r1, 1, 0)});
  double sum = 0.0;
  for (int k = 0; k < n; ++k) {
    sum += exchange_area(sector, polygon({{0, 0, h}, corner(r2, k + 1, h), corner(r2, k, h)}));
  }
  return n * sum;
}

TEST(ClosedForm, OpposedRectanglesC11) {
  for (const double a : {0.05, 1.0, 7.0}) {
    for (const double b : {0.1, 1.0, 3.0}) {
      for (const double c : {0.3, 1.0, 5.0}) {
        const double f =
            exchange_area(level(0, a, 0, b, 0, true), level(0, a, 0, b, c, false)) / (a * b);
        EXPECT_NEAR(f, howell_c11(a, b, c), kAnalytic) << a << " " << b << " " << c;
      }
    }
  }
  EXPECT_NEAR(howell_c11(1, 1, 1), 0.199825, 1e-6);  // as the textbooks print it
}

TEST(ClosedForm, RectanglesAtACommonEdgeC14) {
  for (const double w : {0.05, 1.0, 7.0}) {
    for (const double h : {0.1, 1.0, 3.0}) {
      const double f = exchange_area(level(0, w, 0, 2, 0, true), upright(0, 2, 0, h)) / (2 * w);
      EXPECT_NEAR(f, howell_c14(2, w, h), kAnalytic) << w << " " << h;
    }
  }
  EXPECT_NEAR(howell_c14(1, 1, 1), 0.200044, 1e-6);
}

TEST(ClosedForm, ParallelRectanglesOfAnySizesC13) {
  const double x[] = {0.2, 1.5}, y[] = {-1.0, 0.5}, xi[] = {1.0, 1.8}, eta[] = {0.25, 4.0};
  for (const double z : {0.1, 0.7, 4.0}) {
    const double f = exchange_area(level(x[0], x[1], y[0], y[1], 0, true),
                                   level(xi[0], xi[1], eta[0], eta[1], z, false)) /
                     ((x[1] - x[0]) * (y[1] - y[0]));
    EXPECT_NEAR(f, howell_c13(x, y, xi, eta, z), kAnalytic) << z;
  }
}

TEST(ClosedForm, RectanglesAtARightAngleOfAnySizesC15) {
  const double y[] = {-1.0, 0.5}, eta[] = {0.25, 4.0};
  for (const double from : {0.0, 0.3}) {
    for (const double above : {0.0, 0.4}) {
      const double x[] = {from, 1.5}, xi[] = {above, 1.8};
      const double f = exchange_area(level(x[0], x[1], y[0], y[1], 0, true),
                                     upright(eta[0], eta[1], xi[0], xi[1])) /
                       ((x[1] - x[0]) * (y[1] - y[0]));
      EXPECT_NEAR(f, howell_c15(x, y, xi, eta), kAnalytic) << from << " " << above;
    }
  }
}

TEST(ClosedForm, CoaxialDiscsC41) {
  for (const auto& [r1, r2, h] : {std::tuple(1.0, 1.0, 1.0), std::tuple(0.4, 2.0, 0.5),
                                  std::tuple(2.0, 0.3, 0.1), std::tuple(0.1, 0.2, 5.0)}) {
    // What the sides of polygons cut off is a series in 1/n²: three polygons give the limit but for
    // its third term (Richardson).
    const double n32 = discs(r1, r2, h, 32), n64 = discs(r1, r2, h, 64),
                 n128 = discs(r1, r2, h, 128);
    const double coarse = (4.0 * n64 - n32) / 3.0, fine = (4.0 * n128 - n64) / 3.0;
    const double f = (16.0 * fine - coarse) / 15.0 / (kPiD * r1 * r1);
    EXPECT_NEAR(f, howell_c41(r1, r2, h), 1e-9);  // 2e-10 at most was seen
  }
}

TEST(ClosedForm, WhatLiesBehindThePlaneIsCutOff) {
  // A wall that reaches through the floor: only the part above it counts, and from the floor only
  // what is in front of the wall.
  const double all = exchange_area(level(-3, 2, 0, 1, 0, true), upright(0, 1, -4, 1.5));
  EXPECT_NEAR(all / 2.0, howell_c14(1, 2, 1.5), kAnalytic);
  EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0, true), level(0, 1, 0, 1, 1, true)), 0.0);
  EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0, true), level(2, 3, 0, 1, 0, true)), 0.0);
}

TEST(ClosedForm, PointsAgreeWithTheirMeanOverASurface) {
  const Polygon floor = level(0, 1, 0, 1, 0, true), lamp = level(0.2, 1.4, -0.3, 0.6, 0.8, false);
  // Gauss-Legendre of two points a side on 16x16 cells is exact far below the tolerance.
  constexpr int kCells = 16;
  const double offset = 0.5 / std::sqrt(3.0);
  double sum = 0.0;
  for (int i = 0; i < 2 * kCells; ++i) {
    for (int j = 0; j < 2 * kCells; ++j) {
      const auto place = [&](int k) {
        return (k / 2 + 0.5 + (k % 2 == 0 ? -offset : offset)) / kCells;
      };
      sum += point_to_polygon({place(i), place(j), 0}, {0, 0, 1}, lamp);
    }
  }
  EXPECT_NEAR(sum / (4.0 * kCells * kCells), exchange_area(floor, lamp), kAnalytic);
}

TEST(ClosedForm, CubatureStaysWithinItsError) {
  Random random(1);
  const auto anywhere = [&] {
    const double x = static_cast<double>(random.unit()), y = static_cast<double>(random.unit());
    return dvec3(x, y, static_cast<double>(random.unit())) * 2.0 - 1.0;
  };
  int compared = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const dvec3 apart =
        glm::normalize(anywhere()) * (3.0 + 20.0 * static_cast<double>(random.unit()));
    ElementShape shapes[2];
    for (int s = 0; s < 2; ++s) {
      ElementShape& shape = shapes[s];
      for (dvec3& corner : shape.corners) corner = anywhere() + (s == 0 ? dvec3(0.0) : apart);
      const auto& [a, b, c] = shape.corners;
      const dvec3 area = glm::cross(b - a, c - a);
      shape.area = 0.5 * glm::length(area);
      shape.normal = glm::normalize(area);
      shape.centre = (a + b + c) / 3.0;
      for (const dvec3& corner : shape.corners) {
        shape.radius = std::max(shape.radius, glm::distance(corner, shape.centre));
      }
    }
    const double closed = exchange_area(Polygon(shapes[0].corners), Polygon(shapes[1].corners));
    const double used = unoccluded_exchange(shapes[0], shapes[1], 0.0);
    EXPECT_NEAR(used, closed, kCubatureError * closed + 1e-12);
    compared += closed > 0.0 ? 1 : 0;
  }
  EXPECT_GT(compared, 3000);
}

struct Room {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;
  Patches patches;
  StopFlag stop{false};
  FormFactors factors;

  Room(Scene given, std::size_t count)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)),
        patches(make_patches(scene, world, *tracer, PatchOptions{.count = count})),
        factors(world, *tracer, patches, stop) {}
};

/// A closed room with a box that floats in it; one wall emits.
Scene furnished_room() {
  Scene scene = test::box_room(Vec3(2, 2, 2), 0.5f, 1.0f);
  const MaterialId grey = test::add_material(scene, 0.5f, 0.0f);
  for (std::size_t wall = 1; wall < 6; ++wall) scene.meshes[wall].material = grey;
  const Vec3 corner(-0.4f, -0.3f, -0.2f), x(0.7f, 0.1f, 0), y(-0.1f, 0.6f, 0), z(0, 0, 0.5f);
  test::add_quad(scene, grey, corner, z, y);
  test::add_quad(scene, grey, corner, x, z);
  test::add_quad(scene, grey, corner, y, x);
  test::add_quad(scene, grey, corner + x + y + z, -y, -z);
  test::add_quad(scene, grey, corner + x + y + z, -z, -x);
  test::add_quad(scene, grey, corner + x + y + z, -x, -y);
  return scene;
}

TEST(FormFactors, RowsOfAConvexRoomSumToOneWithoutARay) {
  const Room room(test::box_room(Vec3(2, 3, 4), 0.5f, 1.0f), 400);
  const RowSums sums = row_sums(room.patches, room.factors);
  // The cubatures' share of a row errs by less than they do at worst.
  EXPECT_NEAR(sums.least, 1.0, kCubatureError);
  EXPECT_NEAR(sums.most, 1.0, kCubatureError);
  EXPECT_EQ(room.factors.counts().rays, 0u);
  EXPECT_EQ(room.factors.counts().screened_pairs, 0u);
}

TEST(FormFactors, RowsOfARoomWithABoxInItSumToOneWithinTheSamplesError) {
  const Room room(furnished_room(), 1000);
  EXPECT_GT(room.factors.counts().screened_pairs, 0u);
  EXPECT_GT(room.factors.counts().open_pairs, 0u);
  const RowSums sums = row_sums(room.patches, room.factors);
  // A pair errs by 1/8 of its factor at worst, and in a row tens of such pairs add up; the rows'
  // errors are independent and cancel in the mean.
  EXPECT_NEAR(sums.mean, 1.0, 2e-3);
  EXPECT_NEAR(sums.least, 1.0, 0.04);
  EXPECT_NEAR(sums.most, 1.0, 0.04);
}

TEST(FormFactors, AreReciprocal) {
  const Room room(furnished_room(), 500);
  for (std::size_t i = 0; i < room.factors.size(); ++i) {
    EXPECT_EQ(room.factors.row(i)[i], 0.0f);
    for (std::size_t j = 0; j < i; ++j) {
      const double there =
          room.patches.exposed_area(i) * static_cast<double>(room.factors.row(i)[j]);
      const double back =
          room.patches.exposed_area(j) * static_cast<double>(room.factors.row(j)[i]);
      EXPECT_NEAR(there, back, 2e-7 * std::max(there, back));  // two roundings of float
    }
  }
}

TEST(FormFactors, AreTheSameOnAnyNumberOfThreads) {
  std::vector<std::vector<float>> rows;
  for (const int threads : {1, 3}) {
    ThreadScope scope(threads);
    scope.run([&] {
      const Room room(furnished_room(), 300);
      std::vector<float>& all = rows.emplace_back();
      for (std::size_t i = 0; i < room.factors.size(); ++i) {
        all.insert(all.end(), room.factors.row(i).begin(), room.factors.row(i).end());
      }
    });
  }
  EXPECT_EQ(rows[0], rows[1]);
}

TEST(FormFactors, AScreenHidesWhatIsBehindIt) {
  Scene scene = test::box_room(Vec3(2, 2, 2), 0.5f, 1.0f);
  // From wall to wall, so that the room falls into two.
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(0, -1, -1), Vec3(0, 2, 0),
                 Vec3(0, 0, 2));
  const Room room(std::move(scene), 600);
  for (std::size_t i = 0; i < room.factors.size(); ++i) {
    const dvec3 a = room.patches.centre[room.patches.patch[i]];
    for (std::size_t j = 0; j < room.factors.size(); ++j) {
      const dvec3 b = room.patches.centre[room.patches.patch[j]];
      // Patches that the screen's plane cuts have a part on either side.
      if (a.x < -0.3 && b.x > 0.3) {
        EXPECT_EQ(room.factors.row(i)[j], 0.0f);
      }
    }
  }
}

}  // namespace
}  // namespace lantern
