// SPDX-License-Identifier: MIT
#include "lantern/image/tone.h"

#include <gtest/gtest.h>

#include <limits>

namespace lantern {
namespace {

int grey(float radiance, const Tone& tone = {}) { return to_srgb8(Rgb(radiance), tone)[0]; }

// Values of the sRGB curve worked out in 40 digits from IEC 61966-2-1 and rounded to bytes.
TEST(Tone, KnownBytesOfTheSrgbCurve) {
  EXPECT_EQ(grey(0.0f), 0);
  EXPECT_EQ(grey(0.001f), 3);       // 3.29, on the straight part
  EXPECT_EQ(grey(0.0031308f), 10);  // 10.31, where the parts meet
  EXPECT_EQ(grey(0.01f), 25);       // 25.46
  EXPECT_EQ(grey(0.18f), 118);      // 117.65
  EXPECT_EQ(grey(0.21404f), 127);   // 127.50 from below: the middle of the bytes
  EXPECT_EQ(grey(0.5f), 188);       // 187.52
  EXPECT_EQ(grey(1.0f), 255);
}

TEST(Tone, ClipsWhatCannotBeShown) {
  EXPECT_EQ(grey(-1.0f), 0);
  EXPECT_EQ(grey(7.0f), 255);
  for (const ToneCurve curve : {ToneCurve::kPlain, ToneCurve::kFilmic}) {
    EXPECT_EQ(grey(std::numeric_limits<float>::quiet_NaN(), {0.0f, curve}), 0);
    EXPECT_EQ(grey(kInfinity, {0.0f, curve}), 255);
    EXPECT_EQ(grey(-kInfinity, {0.0f, curve}), 0);
    EXPECT_EQ(grey(std::numeric_limits<float>::max(), {0.0f, curve}), 255);
  }
}

TEST(Tone, SrgbAndBackIsTheSameByte) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(grey(srgb_to_linear(static_cast<float>(i) / 255.0f)), i);
}

TEST(Tone, OneStopDoublesRadiance) {
  for (const ToneCurve curve : {ToneCurve::kPlain, ToneCurve::kFilmic}) {
    for (float radiance = 0.001f; radiance < 1.0f; radiance *= 1.3f) {
      EXPECT_EQ(to_srgb8(Rgb(radiance), {1.0f, curve}),
                to_srgb8(Rgb(2.0f * radiance), {0.0f, curve}));
    }
  }
  EXPECT_GT(grey(0.2f, {1.0f}), grey(0.2f));
}

TEST(Tone, CurvesNeverFall) {
  for (const ToneCurve curve : {ToneCurve::kPlain, ToneCurve::kFilmic}) {
    int before = 0;
    for (float radiance = 1e-4f; radiance < 1e4f; radiance *= 1.01f) {
      const int now = grey(radiance, {0.0f, curve});
      ASSERT_GE(now, before) << radiance;
      before = now;
    }
    EXPECT_EQ(before, 255);
  }
}

// By hand: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) is 0.26687 at 0.18 and 0.80380 at 1, in
// sRGB 141.13 and 231.60 of 255.
TEST(Tone, FilmicKeepsHighlightsApart) {
  const auto filmic = [](float radiance) { return grey(radiance, {0.0f, ToneCurve::kFilmic}); };
  EXPECT_EQ(filmic(0.18f), 141);
  EXPECT_EQ(filmic(1.0f), 232);
  EXPECT_LT(filmic(1.0f), filmic(3.0f));
  EXPECT_LT(filmic(3.0f), 255);
  EXPECT_EQ(filmic(7.3f), 255);
}

TEST(Tone, ChannelsAreIndependent) {
  const auto bytes = to_srgb8(Rgb(0.0f, 0.5f, 4.0f), {});
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 3>{0, 188, 255}));
}

}  // namespace
}  // namespace lantern
