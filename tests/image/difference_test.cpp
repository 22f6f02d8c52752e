// SPDX-License-Identifier: MIT
#include "lantern/image/difference.h"

#include "lantern/core/error.h"
#include "lantern/image/tone.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace lantern {
namespace {

TEST(Difference, IsSigned) {
  const Image out =
      difference(Image(1, 1, Rgb(1.0f, 2.0f, 3.0f)), Image(1, 1, Rgb(2.0f, 2.0f, 0.5f)));
  EXPECT_EQ(out.at(0, 0), Rgb(-1.0f, 0.0f, 2.5f));
}

TEST(Difference, PaintsTheSignAndTheAmount) {
  const Image reference(1, 1, Rgb(1.0f));
  const auto paint = [&](float value, float full) {
    return paint_difference(Image(1, 1, Rgb(value)), reference, full).at(0, 0);
  };
  EXPECT_EQ(paint(1.0f, 0.1f), Rgb(1.0f));
  const Rgb brighter = paint(2.0f, 0.1f), darker = paint(0.0f, 0.1f);
  EXPECT_GT(brighter.r, 4.0f * brighter.b);
  EXPECT_GT(darker.b, 4.0f * darker.r);
  // Relative to sqrt(1 + 0.01) = 1.005 the difference of 0.5 is 0.4975: full from there on.
  EXPECT_EQ(paint(1.5f, 0.49f), brighter);
  EXPECT_NE(paint(1.5f, 0.51f), brighter);
  // Paler the smaller it is.
  EXPECT_GT(paint(1.01f, 0.1f).g, paint(1.05f, 0.1f).g);
  EXPECT_GT(paint(1.05f, 0.1f).g, brighter.g);
}

// Against black the floor of 0.01 bounds what is divided by: 0.02 is 0.2 of 0.1.
TEST(Difference, BlackReferencesHaveAFloor) {
  const Image black(1, 1), faint(1, 1, Rgb(0.02f)), bright(1, 1, Rgb(1.0f));
  const auto paint = [&](const Image& a, float full) {
    return paint_difference(a, black, full).at(0, 0);
  };
  EXPECT_EQ(paint(faint, 0.19f), paint(bright, 0.19f));
  EXPECT_NE(paint(faint, 0.21f), paint(bright, 0.21f));
}

TEST(Difference, ErrorsGetBrighter) {
  std::array<float, 101> errors;
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = static_cast<float>(i) / 100.0f;
  const Image painted = paint_errors(errors, 101, 1), grey = grey_errors(errors, 101, 1);
  EXPECT_EQ(painted.at(0, 0), Rgb(0.0f));
  for (int x = 1; x <= 100; ++x) {
    EXPECT_GT(luminance(painted.at(x, 0)), luminance(painted.at(x - 1, 0))) << x;
    EXPECT_EQ(grey.at(x, 0), Rgb(errors[static_cast<std::size_t>(x)]));
  }
}

TEST(Difference, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(difference(Image(1, 2), Image(2, 1)), Error);
  EXPECT_THROW(paint_difference(Image(1, 2), Image(2, 1), 1.0f), Error);
  const Image broken(1, 1, Rgb(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_THROW(difference(broken, Image(1, 1)), Error);
}

}  // namespace
}  // namespace lantern
