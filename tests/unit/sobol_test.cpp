// SPDX-License-Identifier: MIT
#include "lantern/sampling/sobol.h"

#include "lantern/core/hash.h"

#include "tests/statistical/chi_square.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace lantern {
namespace {

int cell(float x, int cells) { return static_cast<int>(x * static_cast<float>(cells)); }

TEST(ScrambledSobol, HasAPowerOfTwoOfPoints) {
  for (const auto& [wanted, count] :
       {std::pair{1u, 1u}, {2u, 2u}, {3u, 4u}, {64u, 64u}, {65u, 128u}}) {
    EXPECT_EQ(ScrambledSobol(wanted).count(), count);
  }
}

TEST(ScrambledSobol, EveryCoordinateHasOnePointInEachStratum) {
  for (const std::uint32_t count : {2u, 16u, 128u}) {
    const ScrambledSobol points(count);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      for (int d = 0; d < kSobolDimensions; ++d) {
        std::set<int> strata;
        for (std::uint32_t i = 0; i < count; ++i) {
          const float x = points.at(i, seed)[d];
          ASSERT_GE(x, 0.0f);
          ASSERT_LT(x, 1.0f);
          strata.insert(cell(x, static_cast<int>(count)));
        }
        EXPECT_EQ(strata.size(), count) << "dimension " << d << ", seed " << seed;
      }
    }
  }
}

/// The first two dimensions are a (0, 2)-sequence: of 2^m points, the first from any multiple on,
/// each elementary interval of area 2^-m holds one, however they are scrambled.
TEST(ScrambledSobol, EveryElementaryIntervalOfTheFirstTwoHoldsOnePoint) {
  const ScrambledSobol points(256);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const int m : {2, 4, 6, 8}) {
      const std::uint32_t count = 1u << m;
      for (std::uint32_t first = 0; first < 256; first += count) {
        for (int k = 0; k <= m; ++k) {
          std::set<int> intervals;
          for (std::uint32_t i = 0; i < count; ++i) {
            const Vec4 p = points.at(first + i, seed);
            intervals.insert((cell(p.x, 1 << k) << (m - k)) + cell(p.y, 1 << (m - k)));
          }
          ASSERT_EQ(intervals.size(), count) << "m " << m << ", k " << k << ", from " << first;
        }
      }
    }
  }
}

/// The others are a net too: for primitive polynomials of degree e the quality is t = Σ (e - 1)
/// [Sobol' 1967], so 1 + 2 = 3 for dimensions 3 and 4: intervals of volume 2^(3-m) hold 2^3.
TEST(ScrambledSobol, ElementaryIntervalsOfAllFourAreFilledEvenly) {
  constexpr int kQuality = 3, m = 8;
  const ScrambledSobol points(1u << m);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (int a = 0; a <= m - kQuality; ++a) {
      for (int b = 0; a + b <= m - kQuality; ++b) {
        for (int c = 0; a + b + c <= m - kQuality; ++c) {
          const int d = m - kQuality - a - b - c;
          std::vector<int> counts(1u << (m - kQuality));
          for (std::uint32_t i = 0; i < points.count(); ++i) {
            const Vec4 p = points.at(i, seed);
            const int place =
                ((cell(p.x, 1 << a) << b | cell(p.y, 1 << b)) << c | cell(p.z, 1 << c)) << d |
                cell(p.w, 1 << d);
            ++counts[static_cast<std::size_t>(place)];
          }
          for (const int n : counts) ASSERT_EQ(n, 1 << kQuality) << a << b << c << d;
        }
      }
    }
  }
}

/// Over seeds every point is uniform in all four coordinates together, and so is the pair that the
/// same number has in another randomisation: they can be put side by side as more dimensions.
TEST(ScrambledSobol, IsUniformOverSeedsAndIndependentBetweenThem) {
  constexpr int kCells = 4, kSeeds = 40'000;
  const ScrambledSobol points(16);
  for (const std::uint32_t number : {0u, 5u, 15u}) {
    std::vector<double> together(kCells * kCells * kCells * kCells), across(together.size());
    for (int s = 0; s < kSeeds; ++s) {
      const Vec4 p = points.at(number, hash(static_cast<std::uint64_t>(s), 0));
      const Vec4 q = points.at(number, hash(static_cast<std::uint64_t>(s), 1));
      const auto place = [](float a, float b, float c, float d) {
        return static_cast<std::size_t>(
            ((cell(a, kCells) * kCells + cell(b, kCells)) * kCells + cell(c, kCells)) * kCells +
            cell(d, kCells));
      };
      ++together[place(p.x, p.y, p.z, p.w)];
      ++across[place(p.x, p.z, q.x, q.z)];
    }
    const std::vector<double> even(together.size(), 1.0 / static_cast<double>(together.size()));
    EXPECT_GT(test::chi_square(together, even, kSeeds).p_value, test::kSignificance) << number;
    EXPECT_GT(test::chi_square(across, even, kSeeds).p_value, test::kSignificance) << number;
  }
}

/// Nested uniform scrambling of two points leaves alike the digits they share, tells apart the next
/// one and makes all behind it independent. Of four points in any order, the first and the second
/// are always in different halves; the first and the third are so half the time, else in different
/// quarters of one half.
TEST(ScrambledSobol, ScramblesTheDigitsBehindUniformly) {
  constexpr int kSeeds = 40'000, kCells = 8;
  const ScrambledSobol points(4);
  for (int d = 0; d < kSobolDimensions; ++d) {
    for (const std::uint32_t other : {1u, 2u}) {
      std::vector<double> counts(kCells * kCells), probabilities(counts.size());
      for (int s = 0; s < kSeeds; ++s) {
        const auto seed = static_cast<std::uint64_t>(s);
        const int a = cell(points.at(0, seed)[d], kCells);
        const int b = cell(points.at(other, seed)[d], kCells);
        ++counts[static_cast<std::size_t>(a * kCells + b)];
      }
      for (int a = 0; a < kCells; ++a) {
        for (int b = 0; b < kCells; ++b) {
          const bool halves_differ = a / 4 != b / 4, quarters_differ = a / 2 != b / 2;
          const double far = halves_differ ? 1.0 / 32.0 : 0.0;
          const double near = !halves_differ && quarters_differ ? 1.0 / 16.0 : 0.0;
          probabilities[static_cast<std::size_t>(a * kCells + b)] =
              other == 1 ? far : 0.5 * (far + near);
        }
      }
      EXPECT_GT(test::chi_square(counts, probabilities, kSeeds).p_value, test::kSignificance)
          << "dimension " << d << ", points 0 and " << other;
    }
  }
}

}  // namespace
}  // namespace lantern
