// SPDX-License-Identifier: MIT
#include "lantern/core/hash.h"
#include "lantern/sampling/distribution.h"
#include "lantern/sampling/halton.h"
#include "lantern/sampling/warp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

namespace lantern {
namespace {

using ::testing::Each;
using ::testing::Eq;

TEST(RadicalInverse, MatchesValuesWorkedByHand) {
  struct Row {
    std::uint32_t base;
    std::uint64_t index;
    double numerator, denominator;
  };
  // Digits of the index written backwards behind the point.
  constexpr Row kRows[] = {
      {2, 0, 0, 1},    {2, 1, 1, 2},    {2, 2, 1, 4},     {2, 3, 3, 4},    {2, 4, 1, 8},
      {2, 5, 5, 8},    {2, 6, 3, 8},    {2, 7, 7, 8},     {2, 8, 1, 16},   {2, 11, 13, 16},
      {3, 0, 0, 1},    {3, 1, 1, 3},    {3, 2, 2, 3},     {3, 3, 1, 9},    {3, 4, 4, 9},
      {3, 5, 7, 9},    {3, 6, 2, 9},    {3, 7, 5, 9},     {3, 8, 8, 9},    {3, 9, 1, 27},
      {3, 19, 11, 27}, {5, 1, 1, 5},    {5, 4, 4, 5},     {5, 5, 1, 25},   {5, 7, 11, 25},
      {5, 24, 24, 25}, {5, 25, 1, 125}, {5, 86, 38, 125}, {7, 48, 48, 49}, {11, 12, 12, 121},
  };
  for (const Row& row : kRows) {
    EXPECT_EQ(radical_inverse(row.base, row.index), row.numerator / row.denominator)
        << "base " << row.base << ", index " << row.index;
  }
}

// A routine that starts with 1/p in integers returns 0 for every index.
TEST(RadicalInverse, OfOneIsTheBasesReciprocal) {
  for (int dimension = 0; dimension < kHaltonDimensions; ++dimension) {
    const std::uint32_t base = halton_base(dimension);
    EXPECT_EQ(radical_inverse(base, 1), 1.0 / base);
  }
}

TEST(RadicalInverse, StaysBelowOneForTheLargestIndices) {
  for (const std::uint32_t base : {2u, 3u, 7u, 8161u}) {
    for (const std::uint64_t index : {~std::uint64_t{0}, (std::uint64_t{1} << 53) - 1}) {
      EXPECT_LT(radical_inverse(base, index), 1.0);
      EXPECT_LT(scrambled_radical_inverse(base, index, 1), 1.0);
    }
  }
}

TEST(RadicalInverse, IsTheSameWhereTheDivisionChangesItsForm) {
  // 2^31 - 1 is the last index divided by multiplication. Each value is the sum of its digits.
  for (const std::uint32_t base : {3u, 7u, 59u, 8161u}) {
    for (std::uint64_t index = (std::uint64_t{1} << 31) - 100;
         index < (std::uint64_t{1} << 31) + 100; ++index) {
      double expected = 0.0, weight = 1.0;
      for (std::uint64_t rest = index; rest != 0; rest /= base) {
        weight /= base;
        expected += static_cast<double>(rest % base) * weight;
      }
      ASSERT_NEAR(radical_inverse(base, index), expected, 1e-15);
    }
  }
}

TEST(IncrementalRadicalInverse, EqualsTheDirectOneToTheLastBit) {
  constexpr std::uint64_t kCount = 1'000'000;
  for (const std::uint32_t base : {2u, 3u, 5u, 7u, 11u}) {
    IncrementalRadicalInverse incremental(base);
    for (std::uint64_t i = 0; i < kCount; ++i, incremental.next()) {
      ASSERT_EQ(incremental.value(), radical_inverse(base, i)) << "base " << base << " at " << i;
    }
  }
}

TEST(HaltonBase, IsThePrimeOfTheDimension) {
  constexpr std::array<std::uint32_t, 10> kFirst = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(halton_base(i), kFirst[static_cast<std::size_t>(i)]);
  EXPECT_EQ(halton_base(99), 541u);  // the 100th and 1000th prime
  EXPECT_EQ(halton_base(999), 7919u);
}

/// A double as the sequence gives it and a hair: strata of base 3 begin at numbers that are
/// rounded.
double above_rounding(double value) { return value + 1e-12; }

struct Scrambling {
  std::optional<std::uint64_t> seed;  // none: plain

  double operator()(std::uint32_t base, std::uint64_t index) const {
    return seed ? scrambled_radical_inverse(base, index, *seed) : radical_inverse(base, index);
  }
};

class Strata : public ::testing::TestWithParam<Scrambling> {};

TEST_P(Strata, EachElementaryIntervalHoldsOnePoint) {
  const Scrambling halton = GetParam();
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j <= 4; ++j) {
      const auto columns = std::size_t{1} << i;
      const auto rows = static_cast<std::size_t>(std::lround(std::pow(3, j)));
      const std::size_t cells = columns * rows;
      for (const std::uint64_t block : {0u, 1u, 17u, 12345u}) {
        std::vector<int> count(cells, 0);
        for (std::uint64_t index = block * cells; index < (block + 1) * cells; ++index) {
          const double x = above_rounding(halton(2, index));
          const double y = above_rounding(halton(3, index));
          const auto column = static_cast<std::size_t>(x * static_cast<double>(columns));
          const auto row = static_cast<std::size_t>(y * static_cast<double>(rows));
          ++count.at(row * columns + column);
        }
        EXPECT_THAT(count, Each(Eq(1))) << columns << " x " << rows << ", block " << block;
      }
    }
  }
}

TEST_P(Strata, ArePermutedInEveryBase) {
  const Scrambling halton = GetParam();
  for (const int dimension : {0, 1, 2, 3, 4, 7, 20, 100, 1023}) {
    const std::uint32_t base = halton_base(dimension);
    std::set<std::uint32_t> strata;
    for (std::uint64_t i = 0; i < base; ++i) {
      strata.insert(static_cast<std::uint32_t>(above_rounding(halton(base, i)) * base));
    }
    EXPECT_EQ(strata.size(), base) << "dimension " << dimension;
  }
}

INSTANTIATE_TEST_SUITE_P(Halton, Strata,
                         ::testing::Values(Scrambling{}, Scrambling{0}, Scrambling{1},
                                           Scrambling{12345}));

class PointSets : public ::testing::TestWithParam<PointSet> {};

TEST_P(PointSets, ReturnNumbersInTheUnitInterval) {
  const PointSet points = GetParam();
  for (int dimension = 0; dimension < kHaltonDimensions + 2; ++dimension) {
    for (const std::uint64_t index : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 24,
                                      (std::uint64_t{1} << 32) - 1, ~std::uint64_t{0}}) {
      const float value = points.at(index, dimension);
      ASSERT_GE(value, 0.0f);
      ASSERT_LT(value, 1.0f);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Halton, PointSets,
                         ::testing::Values(PointSet{Sampler::kHalton, 0},
                                           PointSet{Sampler::kHalton, 5},
                                           PointSet{Sampler::kScrambled, 0},
                                           PointSet{Sampler::kScrambled, 12345}));

TEST(PointSet, IsThePlainSequenceInTheFirstDimensions) {
  const PointSet points;
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      EXPECT_EQ(points.at(i, dimension),
                static_cast<float>(radical_inverse(halton_base(dimension), i)));
    }
  }
}

TEST(PointSet, IsScrambledByItsSeedAndDimension) {
  struct Row {
    PointSet points;
    int first_scrambled;
  };
  for (const auto& [points, first_scrambled] :
       {Row{{Sampler::kHalton, 0}, 4}, Row{{Sampler::kHalton, 7}, 0},
        Row{{Sampler::kScrambled, 0}, 0}}) {
    for (int dimension = first_scrambled; dimension < 30; ++dimension) {
      const std::uint64_t key = hash(points.seed, static_cast<std::uint64_t>(dimension));
      for (std::uint64_t i = 0; i < 100; ++i) {
        EXPECT_EQ(points.at(i, dimension),
                  static_cast<float>(scrambled_radical_inverse(halton_base(dimension), i, key)));
      }
    }
  }
}

TEST(PointSet, DiffersFromSeedToSeed) {
  for (const Sampler sampler : {Sampler::kHalton, Sampler::kScrambled, Sampler::kRandom}) {
    for (const int dimension : {0, 1, 5, 50, kHaltonDimensions}) {
      int equal = 0;
      for (std::uint64_t i = 0; i < 100; ++i) {
        equal += PointSet{sampler, 1}.at(i, dimension) == PointSet{sampler, 2}.at(i, dimension);
      }
      EXPECT_LE(equal, 2) << "dimension " << dimension;
    }
  }
}

TEST(Distribution, ChoosesInProportionAndStretchesTheRest) {
  const std::array<double, 4> weights = {1.0, 2.0, 0.5, 0.5};
  const Distribution distribution(weights);
  EXPECT_EQ(distribution.size(), 4u);
  EXPECT_EQ(distribution.sum(), 4.0);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(distribution.probability(i), static_cast<float>(weights[i] / 4.0));
  }
  // The bounds 1/4, 3/4, 7/8 are exact, and so is the rest.
  const auto expect = [&](float u, std::size_t index, float rest) {
    const Distribution::Choice choice = distribution.choose(u);
    EXPECT_EQ(choice.index, index) << u;
    EXPECT_EQ(choice.rest, rest) << u;
    EXPECT_EQ(choice.probability, distribution.probability(index)) << u;
  };
  expect(0.0f, 0, 0.0f);
  expect(0.125f, 0, 0.5f);
  expect(0.25f, 1, 0.0f);
  expect(0.5f, 1, 0.5f);
  expect(0.75f, 2, 0.0f);
  expect(0.875f, 3, 0.0f);
  expect(0.9375f, 3, 0.5f);
}

TEST(Distribution, ChoosesExactlyItsShareOfAnEquidistantSet) {
  const std::array<double, 5> weights = {3.0, 0.0, 1.0, 10.0, 2.0};
  const Distribution distribution(weights);
  std::array<int, 5> count{};
  for (int k = 0; k < 1600; ++k) {
    ++count[distribution.choose((static_cast<float>(k) + 0.5f) / 1600.0f).index];
  }
  EXPECT_THAT(count, ::testing::ElementsAre(300, 0, 100, 1000, 200));
}

TEST(Distribution, NeverChoosesWhatHasNoWeight) {
  const std::array<double, 6> weights = {0.0, 0.0, 0.1, 0.0, 0.7, 0.0};
  const Distribution distribution(weights);
  EXPECT_EQ(distribution.choose(0.0f).index, 2u);
  EXPECT_EQ(distribution.choose(0x1p-149f).index, 2u);
  EXPECT_EQ(distribution.choose(kBelowOne).index, 4u);
  EXPECT_LT(distribution.choose(kBelowOne).rest, 1.0f);
  EXPECT_EQ(distribution.probability(0), 0.0f);
  EXPECT_EQ(distribution.probability(5), 0.0f);
  for (const float near : {0.1f / 0.8f, 0.125f}) {
    for (const float u : {std::nextafter(near, 0.0f), near, std::nextafter(near, 1.0f)}) {
      EXPECT_GT(distribution.choose(u).probability, 0.0f);
    }
  }
}

TEST(Distribution, KeepsAnEntryOfOverwhelmingWeightApart) {
  const std::array<double, 3> weights = {1e-300, 1.0, 1e-300};
  const Distribution distribution(weights);
  EXPECT_EQ(distribution.choose(kBelowOne).index, 1u);
  EXPECT_EQ(distribution.choose(0.5f).index, 1u);
}

TEST(Distribution2D, DrawsEachPointWithTheDensityLookedUpThere) {
  constexpr int kWidth = 7, kHeight = 5;
  std::vector<double> weights(kWidth * kHeight);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<double>(i % 4);
  std::fill_n(weights.begin() + 2 * kWidth, kWidth, 0.0);  // a row without weight
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const Distribution2D distribution(weights, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vec2 centre((static_cast<float>(x) + 0.5f) / kWidth,
                        (static_cast<float>(y) + 0.5f) / kHeight);
      const double weight = weights[static_cast<std::size_t>(y * kWidth + x)];
      // A product of three floats: three roundings.
      EXPECT_NEAR(distribution.pdf(centre), weight / sum * kWidth * kHeight, 1e-6);
    }
  }
  const PointSet points;
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    const auto point = distribution.sample({points.at(i, 0), points.at(i, 1)});
    ASSERT_GT(point.pdf, 0.0f);
    ASSERT_EQ(point.pdf, distribution.pdf(point.position));
  }
}

TEST(Distribution2D, KeepsItsPointsInsideTheSquareAndTheirCells) {
  constexpr int kWidth = 3000;
  std::vector<double> weights(kWidth);
  for (std::size_t i = 1; i < kWidth; i += 2) weights[i] = 1.0;
  const Distribution2D distribution(weights, kWidth, 1);
  for (std::uint32_t i = 0; i <= 1u << 16; ++i) {
    const float u = std::min(static_cast<float>(i) * 0x1p-16f, kBelowOne);
    for (const float near : {u, std::nextafter(u, 0.0f)}) {
      const auto point = distribution.sample({near, near});
      ASSERT_LT(point.position.x, 1.0f);
      ASSERT_LT(point.position.y, 1.0f);
      ASSERT_EQ(point.pdf, distribution.pdf(point.position));
    }
  }
}

constexpr float kCorners[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kBelowOne};

TEST(Warp, StaysInItsDomainUpToTheSquaresBorder) {
  constexpr float kUnit = 1e-6f;  // four roundings of a float near 1
  for (const float x : kCorners) {
    for (const float y : kCorners) {
      const Vec2 u(x, y);
      const Vec2 weights = square_to_triangle(u);
      EXPECT_GE(weights.x, 0.0f);
      EXPECT_GE(weights.y, 0.0f);
      EXPECT_GE(1.0f - weights.x - weights.y, 0.0f);

      EXPECT_LE(glm::length(square_to_disc(u)), 1.0f + kUnit);
      const Vec3 hemisphere = square_to_cosine_hemisphere(u);
      EXPECT_NEAR(glm::length(hemisphere), 1.0f, kUnit);
      EXPECT_GE(hemisphere.z, 0x1p-12f);
      EXPECT_NEAR(glm::length(square_to_sphere(u)), 1.0f, kUnit);
      const float cos_half_angle = std::cos(0.01f);
      const Vec3 cone = square_to_cone(u, cos_half_angle);
      EXPECT_NEAR(glm::length(cone), 1.0f, kUnit);
      EXPECT_GE(cone.z, cos_half_angle);
    }
  }
}

TEST(Warp, TriangleIsContinuousAcrossTheDiagonal) {
  for (float t = 0.0f; t < 1.0f; t += 0.125f) {
    const Vec2 on = square_to_triangle({t, t});
    const Vec2 beside = square_to_triangle({t, std::nextafter(t, 2.0f)});
    EXPECT_NEAR(on.x, beside.x, 1e-6f);
    EXPECT_NEAR(on.y, beside.y, 1e-6f);
  }
}

TEST(Warp, DiscMapsTheCentreAndTheAxes) {
  EXPECT_EQ(square_to_disc({0.5f, 0.5f}), Vec2(0.0f));
  EXPECT_NEAR(glm::distance(square_to_disc({1.0f, 0.5f}), Vec2(1.0f, 0.0f)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(square_to_disc({0.5f, 0.0f}), Vec2(0.0f, -1.0f)), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace lantern
