// SPDX-License-Identifier: MIT
#include "lantern/core/hash.h"
#include "lantern/sampling/distribution.h"
#include "lantern/sampling/halton.h"
#include "lantern/sampling/warp.h"

#include "tests/statistical/chi_square.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace lantern {
namespace {

using test::chi_square;
using test::kSignificance;

// Quantiles of the usual tables (NIST/SEMATECH e-Handbook, 1.3.6.7.4).
TEST(ChiSquare, MatchesTabulatedQuantiles) {
  EXPECT_NEAR(test::chi_square_p_value(3.841, 1), 0.05, 1e-4);
  EXPECT_NEAR(test::chi_square_p_value(18.307, 10), 0.05, 1e-5);
  EXPECT_NEAR(test::chi_square_p_value(29.588, 10), 0.001, 1e-6);
  EXPECT_NEAR(test::chi_square_p_value(124.342, 100), 0.05, 1e-5);
  EXPECT_NEAR(test::chi_square_p_value(77.929, 100), 0.95, 1e-5);
}

/// Where `x` in [0, 1) falls among `bins` equal bins.
std::size_t bin_of(double x, std::size_t bins) {
  return std::min(static_cast<std::size_t>(x * static_cast<double>(bins)), bins - 1);
}

std::vector<double> uniform(std::size_t bins) {
  return std::vector<double>(bins, 1.0 / static_cast<double>(bins));
}

// Over seeds every scrambled value is uniform, that of index 0 and of small indices included.
TEST(Scrambling, MakesEachValueUniformOverSeeds) {
  constexpr std::uint64_t kSeeds = 8192;
  constexpr std::size_t kBins = 64;
  for (const int dimension : {0, 1, 2, 3, 4, 10, 20, 100, 1023}) {
    for (const std::uint64_t index : {0u, 1u, 6u, 1000u}) {
      std::vector<double> counts(kBins, 0.0);
      double mean = 0.0;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const double value = PointSet{Sampler::kScrambled, seed}.at(index, dimension);
        ++counts[bin_of(value, kBins)];
        mean += value / static_cast<double>(kSeeds);
      }
      // Four standard errors of a uniform number's mean: one case in 16 000 errs.
      EXPECT_NEAR(mean, 0.5, 4.0 / std::sqrt(12.0 * static_cast<double>(kSeeds)))
          << "dimension " << dimension << ", index " << index;
      EXPECT_GT(chi_square(counts, uniform(kBins), kSeeds).p_value, kSignificance)
          << "dimension " << dimension << ", index " << index;
    }
  }
}

// What the variance of nested scrambling rests on: two digits go to each pair of unequal digits
// with the same probability.
TEST(Scrambling, CarriesPairsOfDigitsToAllPairsAlike) {
  constexpr std::uint64_t kSeeds = 10'000;
  for (const std::uint32_t base : {2u, 3u, 5u, 7u, 11u}) {
    std::vector<double> counts(base * base, 0.0), probabilities(base * base, 0.0);
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto first = bin_of(scrambled_radical_inverse(base, 0, seed) + 1e-12, base);
      const auto second = bin_of(scrambled_radical_inverse(base, 1, seed) + 1e-12, base);
      ++counts[first * base + second];
    }
    for (std::size_t i = 0; i < base * base; ++i) {
      if (i / base != i % base) probabilities[i] = 1.0 / (base * (base - 1));
    }
    EXPECT_GT(chi_square(counts, probabilities, kSeeds).p_value, kSignificance) << "base " << base;
  }
}

// What makes it nested: behind unequal digits the same digit is permuted independently.
TEST(Scrambling, PermutesADigitByTheDigitsBeforeIt) {
  constexpr std::uint64_t kSeeds = 10'000;
  for (const std::uint32_t base : {2u, 3u, 7u}) {
    for (const int place : {2, 6}) {
      const double scale = std::pow(base, place);
      const auto digit = [&](std::uint64_t index, std::uint64_t seed) {
        const double value = scrambled_radical_inverse(base, index, seed);
        return static_cast<std::uint64_t>((value + 1e-12) * scale) % base;
      };
      std::vector<double> counts(base * base, 0.0);
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        ++counts[digit(0, seed) * base + digit(1, seed)];
      }
      EXPECT_GT(chi_square(counts, uniform(base * base), kSeeds).p_value, kSignificance)
          << "base " << base << ", digit " << place;
    }
  }
}

TEST(Scrambling, IsIndependentBetweenDimensions) {
  constexpr std::uint64_t kSeeds = 16'384;
  constexpr std::size_t kBins = 16;
  for (const int dimension : {0, 1, 4, 20}) {
    std::vector<double> counts(kBins * kBins, 0.0);
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const PointSet points{Sampler::kScrambled, seed};
      ++counts[bin_of(points.at(3, dimension), kBins) * kBins +
               bin_of(points.at(3, dimension + 1), kBins)];
    }
    EXPECT_GT(chi_square(counts, uniform(kBins * kBins), kSeeds).p_value, kSignificance)
        << "dimensions " << dimension << " and the next";
  }
}

TEST(HashedValues, AreUniformOverIndicesAndDimensions) {
  constexpr int kCount = 1 << 14;
  constexpr std::size_t kBins = 16;
  for (const PointSet points : {PointSet{Sampler::kRandom, 0}, PointSet{Sampler::kHalton, 0}}) {
    const int dimension = points.sampler == Sampler::kRandom ? 0 : kHaltonDimensions;
    std::vector<double> counts(kBins * kBins, 0.0);
    for (std::uint64_t i = 0; i < kCount; ++i) {
      ++counts[bin_of(points.at(i, dimension), kBins) * kBins +
               bin_of(points.at(i, dimension + 1), kBins)];
    }
    EXPECT_GT(chi_square(counts, uniform(kBins * kBins), kCount).p_value, kSignificance);
  }
}

struct Runs {
  double mean = 0.0;
  double deviation = 0.0;  // root mean square distance of a run from the true value
};

/// Means over `points` of 4xy (integral 1) at two dimensions, over many seeds.
Runs integrate(Sampler sampler, int dimension, std::uint64_t points) {
  constexpr int kRuns = 256;
  Runs runs;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const PointSet set{sampler, seed};
    double sum = 0.0;
    for (std::uint64_t i = 0; i < points; ++i) {
      sum += 4.0 * static_cast<double>(set.at(i, dimension)) *
             static_cast<double>(set.at(i, dimension + 1));
    }
    const double error = sum / static_cast<double>(points) - 1.0;
    runs.mean += (1.0 + error) / kRuns;
    runs.deviation += error * error / kRuns;
  }
  runs.deviation = std::sqrt(runs.deviation);
  return runs;
}

// Independent points err by sqrt(7/9 / n); scrambled ones without bias and by less, in deep
// dimensions (bases 31 and 37) as well.
TEST(Scrambling, IntegratesWithoutBiasAndBetterThanRandomPoints) {
  constexpr std::uint64_t kPoints = 1024;
  const double random = std::sqrt(7.0 / 9.0 / static_cast<double>(kPoints));
  EXPECT_NEAR(integrate(Sampler::kRandom, 0, kPoints).deviation, random, 0.2 * random);
  for (const int dimension : {0, 4, 10}) {
    const Runs runs = integrate(Sampler::kHalton, dimension, kPoints);
    EXPECT_NEAR(runs.mean, 1.0, 4.0 * runs.deviation / std::sqrt(256.0)) << dimension;
    EXPECT_LT(runs.deviation, 0.5 * random) << dimension;
  }
}

/// A warp of the square onto a disc or a sphere: a point's distance from the middle or its height,
/// with the probability that it is below a bound, and its angle about the axis.
struct Warp {
  std::string name;
  std::function<Vec3(Vec2)> map;        // x and y give the angle
  std::function<double(Vec3)> measure;  // within [low, high]
  double low, high;
  std::function<double(double)> probability_below;
};

std::ostream& operator<<(std::ostream& out, const Warp& warp) { return out << warp.name; }

double height(Vec3 v) { return v.z; }

constexpr float kConeCos = 0.9f;

std::vector<Warp> warps() {
  return {
      {"disc", [](Vec2 u) { return Vec3(square_to_disc(u), 0.0f); },
       [](Vec3 v) { return glm::length(v); }, 0.0, 1.0, [](double r) { return r * r; }},
      {"cosine_hemisphere", square_to_cosine_hemisphere, height, 0.0, 1.0,
       [](double z) { return z * z; }},
      {"sphere", square_to_sphere, height, -1.0, 1.0, [](double z) { return 0.5 * (z + 1.0); }},
      {"cone", [](Vec2 u) { return square_to_cone(u, kConeCos); }, height, kConeCos, 1.0,
       [](double z) { return (z - kConeCos) / (1.0 - kConeCos); }},
  };
}

class WarpStatistics : public ::testing::TestWithParam<Warp> {};

TEST_P(WarpStatistics, FollowTheirDensity) {
  constexpr std::size_t kRings = 9, kSectors = 11;  // no multiples of the sequence's bases' strata
  constexpr int kCount = 100'000;
  const Warp& warp = GetParam();
  std::vector<double> probabilities;
  const double step = (warp.high - warp.low) / kRings;
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const double low = warp.low + step * static_cast<double>(ring);
    const double share = warp.probability_below(low + step) - warp.probability_below(low);
    probabilities.insert(probabilities.end(), kSectors, share / kSectors);
  }
  for (const PointSet points : {PointSet{Sampler::kRandom, 1}, PointSet{Sampler::kHalton, 0}}) {
    std::vector<double> counts(probabilities.size(), 0.0);
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const Vec3 v = warp.map({points.at(i, 0), points.at(i, 1)});
      const double turn = std::atan2(v.y, v.x) / (2.0 * glm::pi<double>());
      const double along = (warp.measure(v) - warp.low) / (warp.high - warp.low);
      ++counts[bin_of(along, kRings) * kSectors + bin_of(turn - std::floor(turn), kSectors)];
    }
    const test::ChiSquare result = chi_square(counts, probabilities, kCount);
    EXPECT_GT(result.p_value, kSignificance);
    if (points.sampler == Sampler::kHalton) {
      // Far more even than independent points, whose statistic is about the number of bins.
      EXPECT_LT(result.statistic, 0.1 * static_cast<double>(counts.size()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, WarpStatistics, ::testing::ValuesIn(warps()),
                         [](const auto& instance) { return instance.param.name; });

TEST(TriangleWarp, IsUniform) {
  constexpr std::size_t kSide = 13;
  constexpr int kCount = 100'000;
  std::vector<double> probabilities(kSide * kSide, 0.0);
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x + y < kSide; ++x) {
      // Of the area 1/2; the diagonal halves the cells it crosses.
      const double share = x + y + 1 == kSide ? 1.0 : 2.0;
      probabilities[y * kSide + x] = share / static_cast<double>(kSide * kSide);
    }
  }
  for (const PointSet points : {PointSet{Sampler::kRandom, 1}, PointSet{Sampler::kHalton, 0}}) {
    std::vector<double> counts(kSide * kSide, 0.0);
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const Vec2 w = square_to_triangle({points.at(i, 0), points.at(i, 1)});
      ++counts[bin_of(w.y, kSide) * kSide + bin_of(w.x, kSide)];
    }
    EXPECT_GT(chi_square(counts, probabilities, kCount).p_value, kSignificance);
  }
}

// With pdf_area = 1/A the estimator Σ f/pdf of a linear f tends to A times f at the centroid.
TEST(TriangleWarp, HasTheDensityOneOverArea) {
  const Vec3 a(1.0f, 0.0f, 2.0f), b(4.0f, 0.5f, 2.0f), c(0.0f, 3.0f, -1.0f);
  const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
  constexpr int kCount = 1 << 14;
  const PointSet points;
  double sum = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const Vec2 w = square_to_triangle({points.at(i, 0), points.at(i, 1)});
    const Vec3 p = a + w.x * (b - a) + w.y * (c - a);
    sum += (p.x + 2.0 * p.y - p.z) * area / kCount;
  }
  const Vec3 centroid = (a + b + c) / 3.0f;
  // The discrepancy of Halton's first n points in two dimensions is about log²(n)/n = 0.006.
  EXPECT_NEAR(sum / area, centroid.x + 2.0 * centroid.y - centroid.z, 0.006);
}

TEST(Distribution, ChoosesByWeightAndLeavesAUniformRest) {
  const std::vector<double> weights = {0.3, 0.0, 2.0, 0.7, 1.1};
  const Distribution distribution(weights);
  constexpr std::size_t kBins = 10;
  constexpr int kCount = 100'000;
  std::vector<double> probabilities;
  for (const double weight : weights) {
    probabilities.insert(probabilities.end(), kBins, weight / distribution.sum() / kBins);
  }
  for (const PointSet points : {PointSet{Sampler::kRandom, 1}, PointSet{Sampler::kHalton, 0}}) {
    std::vector<double> counts(probabilities.size(), 0.0);
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const Distribution::Choice choice = distribution.choose(points.at(i, 0));
      ++counts[choice.index * kBins + bin_of(choice.rest, kBins)];
    }
    EXPECT_GT(chi_square(counts, probabilities, kCount).p_value, kSignificance);
  }
}

TEST(Distribution2D, FollowsItsDensity) {
  constexpr int kWidth = 6, kHeight = 4, kParts = 2;  // each cell is counted in 2 x 2 parts
  constexpr int kColumns = kWidth * kParts, kRows = kHeight * kParts, kCount = 100'000;
  std::vector<double> weights;
  for (int i = 0; i < kWidth * kHeight; ++i) weights.push_back((i * 7) % 5);
  const Distribution2D distribution(weights, kWidth, kHeight);
  std::vector<double> probabilities;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const Vec2 centre((static_cast<float>(x) + 0.5f) / kColumns,
                        (static_cast<float>(y) + 0.5f) / kRows);
      probabilities.push_back(static_cast<double>(distribution.pdf(centre)) / (kColumns * kRows));
    }
  }
  for (const PointSet points : {PointSet{Sampler::kRandom, 1}, PointSet{Sampler::kHalton, 0}}) {
    std::vector<double> counts(probabilities.size(), 0.0);
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const Vec2 p = distribution.sample({points.at(i, 0), points.at(i, 1)}).position;
      ++counts[bin_of(p.y, kRows) * kColumns + bin_of(p.x, kColumns)];
    }
    EXPECT_GT(chi_square(counts, probabilities, kCount).p_value, kSignificance);
  }
}

}  // namespace
}  // namespace lantern
