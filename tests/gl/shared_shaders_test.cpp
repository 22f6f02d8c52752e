// SPDX-License-Identifier: MIT
// Formulas that GLSL and C++ share, in float as a GPU computes them, against double precision.
#include "lantern/core/hash.h"
#include "lantern/core/math.h"
#include "lantern/radiosity/hemicube.h"
#include "lantern/radiosity/polygon_factor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace lantern {
namespace shared {

using namespace glm;
#define LANTERN_SHARED inline
#include "shaders/form_factor.glsl"
#include "shaders/hemicube.glsl"
#undef LANTERN_SHARED

}  // namespace shared

namespace {

Vec3 random_point(std::uint64_t key, std::uint64_t number) {
  const auto unit = [&](std::uint64_t i) { return to_unit_float(hash(key, number, i)); };
  return Vec3(unit(0), unit(1), unit(2)) * 2.0f - 1.0f;
}

TEST(SharedFormFactor, OfATriangleIsLamberts) {
  int cut = 0, whole = 0, behind = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Vec3 a = random_point(i, 0), b = random_point(i, 1), c = random_point(i, 2);
    const Vec3 normal = glm::normalize(random_point(i, 3));
    const std::array corners = {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
    const bool faces = glm::dot(glm::cross(b - a, c - a), a) < 0.0f;
    const double expected =
        faces ? point_to_polygon(glm::dvec3(0.0), glm::dvec3(normal),
                                 clip(Polygon(corners), glm::dvec3(0.0), glm::dvec3(normal)))
              : 0.0;
    // Sums of three or four angles: some roundings of their size, more where the point nearly lies
    // in the triangle's plane and the direction of an edge's plane is lost.
    EXPECT_NEAR(static_cast<double>(shared::point_to_triangle(a, b, c, normal)), expected, 2e-5)
        << i;
    const int above =
        (glm::dot(a, normal) > 0.0f) + (glm::dot(b, normal) > 0.0f) + (glm::dot(c, normal) > 0.0f);
    ++(!faces || above == 0 ? behind : above == 3 ? whole : cut);
  }
  EXPECT_GT(cut, 5000);
  EXPECT_GT(whole, 500);
  EXPECT_GT(behind, 5000);
}

TEST(SharedFormFactor, OfADiscIsThatOfAFarTriangleAndStaysBelowOne) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Vec3 a = random_point(i, 0), b = random_point(i, 1), c = random_point(i, 2);
    const Vec3 area_vector = glm::cross(b - a, c - a);
    const Vec3 normal = glm::normalize(random_point(i, 3));
    const Vec3 source_normal = glm::normalize(area_vector);
    const float area = 0.5f * glm::length(area_vector);
    const auto disc = [&](const Vec3& to_centre) {
      return shared::point_to_disc(to_centre, normal, source_normal, area);
    };
    const Vec3 way = glm::normalize(random_point(i, 4)) * 30.0f;
    const Vec3 centre = (a + b + c) / 3.0f;
    const float exact =
        shared::point_to_triangle(a - centre + way, b - centre + way, c - centre + way, normal);
    // The triangle's radius is at most √3: what is neglected is of the order of (√3/30)², times a
    // few where a cosine nearly vanishes.
    EXPECT_NEAR(disc(way), exact, 0.02f * exact + 1e-5f);
    for (const float distance : {1.0f, 1e-2f, 1e-4f}) {
      const float near = disc(glm::normalize(way) * distance);
      EXPECT_GE(near, 0.0f);
      EXPECT_LE(near, 1.0f);
    }
  }
}

TEST(SharedFormFactor, WhatIsAboveTheHorizonIsAShareOfTheArea) {
  const auto area_of = [](const Polygon& polygon) {
    glm::dvec3 sum(0.0);
    const auto corners = polygon.corners();
    for (std::size_t i = 2; i < corners.size(); ++i) {
      sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    }
    return 0.5 * glm::length(sum);
  };
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const std::array corners = {glm::dvec3(random_point(i, 0)), glm::dvec3(random_point(i, 1)),
                                glm::dvec3(random_point(i, 2))};
    const Vec3 up(0.0f, 0.0f, 1.0f);
    const double above = area_of(clip(Polygon(corners), glm::dvec3(0.0), glm::dvec3(up)));
    const auto height = [&](std::size_t k) { return static_cast<float>(corners[k].z); };
    EXPECT_NEAR(static_cast<double>(shared::share_above(height(0), height(1), height(2))),
                above / area_of(Polygon(corners)), 1e-5)
        << i;
  }
}

TEST(SharedHemicube, PixelsSeeAlongTheRaysOfTheCpusHemicube) {
  for (const int n : {16, 64}) {
    const Hemicube cube(n);
    std::set<std::pair<int, int>> met;
    double sum = 0.0;
    for (std::size_t i = 0; i < cube.size(); ++i) {
      const glm::ivec2 pixel = shared::hemicube_pixel(cube.direction(i), n);
      ASSERT_GE(pixel.x, 0);
      ASSERT_GE(pixel.y, 0);
      ASSERT_LT(pixel.x, n);
      ASSERT_LT(pixel.y, 3 * n);
      met.insert({pixel.x, pixel.y});
      const auto delta = static_cast<double>(shared::hemicube_delta(pixel, n));
      // The CPU's are scaled so that they sum to 1; the rest is rounding.
      const double expected = cube.delta()[i] * (1.0 + cube.discretisation());
      EXPECT_NEAR(delta, expected, 1e-5 * expected);
      sum += delta;
    }
    EXPECT_EQ(met.size(), cube.size());
    EXPECT_NEAR(sum, 1.0 + cube.discretisation(), 1e-5);
  }
}

}  // namespace
}  // namespace lantern
