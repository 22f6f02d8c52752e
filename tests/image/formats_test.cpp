// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/read.h"
#include "lantern/image/write.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace lantern {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Colours over 24 powers of two, no two pixels alike; wide enough for runs and dumps in an HDR.
Image sample_image(int width = 37, int height = 19) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<float>(y * width + x + 1);
      const float scale = std::exp2(static_cast<float>((x * 7 + y * 3) % 24 - 12));
      image.at(x, y) = scale * Rgb(std::sin(i) + 1.01f, i / 1000.0f, x < 20 ? 0.25f : 0.5f);
    }
  }
  return image;
}

void expect_same(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)), 0);
}

class Formats : public ::testing::Test {
 protected:
  Image round_trip(const std::string& name, const Image& image, const WriteOptions& options = {}) {
    write_image(folder_ / name, image, options);
    return read_image(folder_ / name);
  }
  test::TemporaryFolder folder_;
};

std::string error_of_writing(const std::filesystem::path& path, const Image& image = Image(2, 2)) {
  try {
    write_image(path, image);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

Image special_values() {
  Image image(2, 1);
  image.at(0, 0) = Rgb(kInfinity, -kInfinity, kNan);
  image.at(1, 0) = Rgb(1e30f, -1e30f, -0.5f);
  return image;
}

TEST_F(Formats, FloatExrIsExact) {
  WriteOptions options;
  options.exr_depth = ExrDepth::kFloat;
  expect_same(round_trip("a.exr", sample_image(), options), sample_image());
}

TEST_F(Formats, PfmIsExact) { expect_same(round_trip("a.pfm", sample_image()), sample_image()); }

// A half keeps 10 bits behind the leading one; rounding to nearest errs by half of the last.
TEST_F(Formats, HalfExrIsRightToElevenBits) {
  const Image before = sample_image();
  const Image after = round_trip("a.exr", before);
  ASSERT_EQ(after.pixels.size(), before.pixels.size());
  for (std::size_t i = 0; i < before.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = before.pixels[i][c];
      // Below 2^-14 halves are spaced evenly by 2^-24.
      const float bound = std::max(std::ldexp(value, -11), 0x1p-25f);
      ASSERT_NEAR(after.pixels[i][c], value, bound) << i;
    }
  }
}

TEST_F(Formats, HalfExrClampsToTheLargestHalf) {
  const Image after = round_trip("a.exr", special_values());
  EXPECT_EQ(after.at(0, 0).r, 65504.0f);
  EXPECT_EQ(after.at(0, 0).g, -65504.0f);
  EXPECT_TRUE(std::isnan(after.at(0, 0).b));
  EXPECT_EQ(after.at(1, 0), Rgb(65504.0f, -65504.0f, -0.5f));
}

TEST_F(Formats, FloatFormatsKeepWhatIsNotFinite) {
  WriteOptions options;
  options.exr_depth = ExrDepth::kFloat;
  for (const char* name : {"a.exr", "a.pfm"}) {
    const Image after = round_trip(name, special_values(), options);
    EXPECT_EQ(after.at(0, 0).r, kInfinity);
    EXPECT_EQ(after.at(0, 0).g, -kInfinity);
    EXPECT_TRUE(std::isnan(after.at(0, 0).b));
    EXPECT_EQ(after.at(1, 0), special_values().at(1, 0));
  }
}

// RGBE: 8 bits for the largest channel, so half a step is 2^-8 of it at most (2^-9 of the next
// power of two), for all three. Narrow pictures are not run-length coded.
TEST_F(Formats, HdrIsRightToOne256thOfTheLargestChannel) {
  for (const int width : {5, 37, 300}) {
    const Image before = sample_image(width, 7);
    const Image after = round_trip("a.hdr", before);
    ASSERT_EQ(after.pixels.size(), before.pixels.size());
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
      const float bound = std::ldexp(max_component(before.pixels[i]), -8);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(after.pixels[i][c], before.pixels[i][c], bound) << i;
      }
    }
  }
}

TEST_F(Formats, HdrKeepsToItsRange) {
  const Image after = round_trip("a.hdr", special_values());
  const float largest = 255.0f * 0x1p119f;
  EXPECT_EQ(after.at(0, 0), Rgb(largest, 0.0f, 0.0f));
  EXPECT_EQ(after.at(1, 0).g, 0.0f);
  EXPECT_EQ(after.at(1, 0).b, 0.0f);
  EXPECT_NEAR(after.at(1, 0).r, 1e30f, 1e30f / 256.0f);

  // The mantissa rounds up to 256 just below a power of two: the exponent must take it.
  EXPECT_EQ(round_trip("b.hdr", Image(1, 1, Rgb(0.9999f))).at(0, 0), Rgb(1.0f));
}

// A black picture of 127 x 1: runs of one each, known to the byte.
TEST_F(Formats, HdrRunsAreRadiances) {
  write_image(folder_ / "a.hdr", Image(127, 1));
  const std::string text = read_text(folder_ / "a.hdr");
  const std::string runs("\2\2\0\177\377\0\377\0\377\0\377\0", 12);
  EXPECT_THAT(text, ::testing::StartsWith("#?RADIANCE\n"));
  EXPECT_THAT(text, ::testing::EndsWith("\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 127\n" + runs));
}

TEST_F(Formats, HdrRadianceIsFreedOfExposure) {
  // The file says 2 and 4, so its first pixel of (1, 0.5, 0.25) is an eighth of that.
  const Image image =
      read_image(std::filesystem::path(LANTERN_SOURCE_DIR) / "fuzz/seeds/image/flat_exposure.hdr");
  EXPECT_EQ(image.at(0, 0), Rgb(1.0f, 0.5f, 0.25f) / 8.0f);
}

// Each byte of a PNG is a rounded sRGB value: half a step of 1/255, times the curve's slope of at
// most 2.28 (at white) when decoded.
TEST_F(Formats, PngIsRightToHalfAStep) {
  Image before(16, 16);
  for (int i = 0; i < 256; ++i) {
    before.at(i % 16, i / 16) = Rgb(static_cast<float>(i) / 255.0f, 0.5f, 0.0f);
  }
  const Image after = round_trip("a.png", before);
  for (int i = 0; i < 256; ++i) {
    const Rgb value = after.at(i % 16, i / 16);
    EXPECT_NEAR(value.r, static_cast<float>(i) / 255.0f, 2.28f * 0.5f / 255.0f);
    EXPECT_NEAR(value.g, 0.5f, 2.28f * 0.5f / 255.0f);
    EXPECT_EQ(value.b, 0.0f);
  }
}

TEST_F(Formats, PngShowsTheTone) {
  WriteOptions options;
  options.tone = {1.5f, ToneCurve::kFilmic};
  const Image image = sample_image();
  write_image(folder_ / "a.png", image, options);
  const Raster raster = decode_raster(read_file(folder_ / "a.png"), "a.png");
  ASSERT_EQ(raster.srgb8.size(), 4 * image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto expected = to_srgb8(image.pixels[i], options.tone);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(raster.srgb8[4 * i + c], expected[c]);
    ASSERT_EQ(raster.srgb8[4 * i + 3], 255);
  }
}

TEST_F(Formats, PngSaysThatItIsSrgb) {
  write_image(folder_ / "a.png", Image(1, 1));
  EXPECT_THAT(read_text(folder_ / "a.png"), ::testing::HasSubstr("sRGB"));
}

TEST_F(Formats, MetadataSurvives) {
  WriteOptions options;
  options.metadata = {{"version", "0.1.0"},
                      {"options", "--lights 60\n--reflectivity 0.6"},
                      {"scene", "r\xc3\xa4ume/caf\xc3\xa9.mesh"},
                      {"type", "also a word of the EXR format"},
                      {"empty", ""}};
  for (const char* name : {"a.exr", "a.png"}) {
    write_image(folder_ / name, Image(3, 2), options);
    EXPECT_EQ(read_metadata(folder_ / name), options.metadata) << name;
  }
  for (const char* name : {"a.hdr", "a.pfm"}) {
    write_image(folder_ / name, Image(3, 2), options);
    EXPECT_TRUE(read_metadata(folder_ / name).empty()) << name;
    EXPECT_NO_THROW(read_image(folder_ / name)) << name;
  }
  EXPECT_THAT(read_text(folder_ / "a.hdr"),
              ::testing::HasSubstr("\n# lantern.options=--lights 60 --reflectivity 0.6\n"));
}

TEST_F(Formats, TheContentDecidesNotTheName) {
  write_image(folder_ / "a.exr", sample_image());
  std::filesystem::rename(folder_ / "a.exr", folder_ / "a.png");
  EXPECT_EQ(read_image(folder_ / "a.png").width, 37);
}

TEST_F(Formats, TheSamePictureIsTheSameFile) {
  for (const char* kind : {".exr", ".png", ".hdr", ".pfm"}) {
    write_image(folder_ / (std::string("a") + kind), sample_image());
    write_image(folder_ / (std::string("b") + kind), sample_image());
    EXPECT_EQ(read_text(folder_ / (std::string("a") + kind)),
              read_text(folder_ / (std::string("b") + kind)));
  }
}

// What these files hold is written in the order of their rows, from the top.
TEST(Seeds, KnownPixels) {
  const std::filesystem::path seeds =
      std::filesystem::path(LANTERN_SOURCE_DIR) / "fuzz/seeds/image";
  for (const char* name : {"rgb.bmp", "raw.tga"}) {
    const Raster raster = decode_raster(read_file(seeds / name), name);
    ASSERT_EQ(raster.width, 5);
    ASSERT_EQ(raster.height, 4);
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_EQ(raster.srgb8[4 * i + 0], 50 * (i % 5)) << name;
      EXPECT_EQ(raster.srgb8[4 * i + 1], 60 * (i / 5)) << name;
      EXPECT_EQ(raster.srgb8[4 * i + 2], 128) << name;
      EXPECT_EQ(raster.srgb8[4 * i + 3], 255) << name;
    }
  }

  const Raster runs = decode_raster(read_file(seeds / "runs.tga"), "runs.tga");
  const std::vector<std::uint8_t> row(runs.srgb8.begin() + 20, runs.srgb8.begin() + 40);
  EXPECT_THAT(row, ::testing::ElementsAre(200, 10, 40, 255, 200, 10, 40, 255, 200, 10, 40, 255,  //
                                          3, 2, 1, 255, 6, 5, 4, 128));

  const Image grey = read_image(seeds / "grey_big_endian.pfm");
  EXPECT_EQ(grey.at(0, 2), Rgb(0.0f));  // rows run from the bottom
  EXPECT_EQ(grey.at(1, 0), Rgb(5.0f));

  const Image luminance = read_image(seeds / "tiles_y.exr");
  ASSERT_EQ(luminance.pixels.size(), 60u);
  // Halves of i/60 < 1, rounded to 2^-12 at most.
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_NEAR(luminance.pixels[i].g, static_cast<float>(i) / 60.0f, 0x1p-12f);
    EXPECT_EQ(luminance.pixels[i].r, luminance.pixels[i].b);
  }
}

// Quality 60 quantises the lowest frequencies of the standard tables in steps of 14 and less. Half
// a step of chroma, weighted by its 1.4, and half a step of luma make 17; rounding twice adds 2.
TEST(Seeds, JpegsShowTheirGradient) {
  for (const char* name : {"baseline.jpg", "progressive.jpg"}) {
    const Raster raster = decode_raster(
        read_file(std::filesystem::path(LANTERN_SOURCE_DIR) / "fuzz/seeds/image" / name), name);
    ASSERT_EQ(raster.width, 24);
    ASSERT_EQ(raster.height, 16);
    for (std::size_t x = 8; x < 24; ++x) {
      const auto expected = to_srgb8(Rgb(static_cast<float>(x) / 24.0f), {})[0];
      EXPECT_NEAR(raster.srgb8[4 * (12 * 24 + x)], expected, 19) << name << " " << x;
    }
  }
}

TEST_F(Formats, RefusesOtherExtensions) {
  for (const char* name : {"a.jpg", "a", "exr", "a.exr.txt"}) {
    EXPECT_THROW(require_image_format(name), Error) << name;
    EXPECT_THAT(error_of_writing(folder_ / name), ::testing::HasSubstr("no picture format"));
  }
  EXPECT_NO_THROW(require_image_format("A.EXR"));
}

TEST_F(Formats, WhatCannotBeWrittenLeavesNothingBehind) {
  write_file(folder_ / "file", "not a folder");
  for (const char* kind : {".exr", ".png", ".hdr", ".pfm"}) {
    const auto below_a_file = folder_ / "file" / (std::string("a") + kind);
    EXPECT_THAT(error_of_writing(below_a_file),
                ::testing::StartsWith(below_a_file.string() + ": cannot be written"));
    const auto nowhere = folder_ / "missing" / (std::string("a") + kind);
    EXPECT_THAT(error_of_writing(nowhere), ::testing::StartsWith(nowhere.string() + ": "));

    // A full device under a name that says what to write.
    const auto full = folder_ / (std::string("full") + kind);
    std::filesystem::create_symlink("/dev/full", full);
    EXPECT_THAT(error_of_writing(full), ::testing::HasSubstr("No space left"));
    std::filesystem::remove(full);

    EXPECT_THAT(error_of_writing(folder_ / (std::string("a") + kind), Image()),
                ::testing::HasSubstr("no pixels"));
  }
  WriteOptions options;
  options.metadata[std::string(80, 'k')] = "longer than PNG allows";
  EXPECT_THROW(write_image(folder_ / "a.png", Image(1, 1), options), Error);

  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

}  // namespace
}  // namespace lantern
