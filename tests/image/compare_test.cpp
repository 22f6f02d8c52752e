// SPDX-License-Identifier: MIT
#include "lantern/image/compare.h"

#include "lantern/core/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lantern {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string message(const Image& a, const Image& b) {
  try {
    compare(a, b);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

// Two pixels, six values; the differences are 1, -2, 0, 0.5, 0, 0, so their squares sum to 5.25.
// All values are sums of powers of 2, so only the last divisions round: 4 units in the last place.
TEST(Compare, NumbersWorkedOutByHand) {
  Image a(2, 1);
  Image b(2, 1);
  a.at(0, 0) = Rgb(2.0f, 1.0f, 0.0f);
  b.at(0, 0) = Rgb(1.0f, 3.0f, 0.0f);
  a.at(1, 0) = Rgb(0.5f, 4.0f, 8.0f);
  b.at(1, 0) = Rgb(0.0f, 4.0f, 8.0f);
  const Comparison result = compare(a, b);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt(5.25 / 6.0));
  EXPECT_DOUBLE_EQ(result.relmse, (1.0 / 1.01 + 4.0 / 9.01 + 0.25 / 0.01) / 6.0);
  EXPECT_DOUBLE_EQ(result.max_difference, 2.0);
  EXPECT_EQ(result.mean_a, glm::dvec3(1.25, 2.5, 4.0));
  EXPECT_EQ(result.mean_b, glm::dvec3(0.5, 3.5, 4.0));
}

TEST(Compare, TheSecondPictureIsTheReference) {
  const Image dark(1, 1, Rgb(0.0f));
  const Image bright(1, 1, Rgb(1.0f));
  EXPECT_DOUBLE_EQ(compare(bright, dark).relmse, 1.0 / 0.01);
  EXPECT_DOUBLE_EQ(compare(dark, bright).relmse, 1.0 / 1.01);
}

TEST(Compare, APictureEqualsItself) {
  const Image a(3, 2, Rgb(0.1f, 20.0f, 3e20f));
  const Comparison result = compare(a, a);
  EXPECT_EQ(result.rmse, 0.0);
  EXPECT_EQ(result.relmse, 0.0);
  EXPECT_EQ(result.max_difference, 0.0);
}

// In float the ones would vanish beside 2^24; in double each counts.
TEST(Compare, SumsInDouble) {
  Image a(1000, 1, Rgb(1.0f));
  a.at(0, 0) = Rgb(0x1p24f);
  EXPECT_DOUBLE_EQ(compare(a, a).mean_a.r, (0x1p24 + 999.0) / 1000.0);
}

TEST(Compare, NamesTheFirstPixelThatIsNotFinite) {
  Image a(4, 3);
  Image b(4, 3);
  b.at(3, 2).b = kNan;
  EXPECT_THAT(message(a, b), ::testing::HasSubstr("second picture is not finite at pixel (3, 2)"));
  a.at(1, 2).r = kInfinity;
  EXPECT_THAT(message(a, b), ::testing::HasSubstr("first picture is not finite at pixel (1, 2)"));
  a.at(2, 0).g = -kInfinity;
  EXPECT_THAT(message(a, b), ::testing::HasSubstr("first picture is not finite at pixel (2, 0)"));
}

TEST(Compare, RefusesOtherSizesAndEmptiness) {
  EXPECT_THAT(message(Image(2, 3), Image(3, 2)), ::testing::HasSubstr("2x3 and 3x2"));
  EXPECT_THAT(message(Image(), Image()), ::testing::HasSubstr("no pixels"));
}

}  // namespace
}  // namespace lantern
