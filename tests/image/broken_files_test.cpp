// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/codec.h"
#include "lantern/image/read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace lantern {
namespace {

using codec::Bytes;

std::map<std::string, Bytes> seeds() {
  std::map<std::string, Bytes> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(LANTERN_SOURCE_DIR) / "fuzz/seeds/image")) {
    files[entry.path().filename().string()] = read_file(entry.path());
  }
  return files;
}

std::string error_of(std::span<const std::byte> bytes) {
  try {
    decode_raster(bytes, "file");
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

std::string error_of(const std::string& text) { return error_of(std::as_bytes(std::span(text))); }

Bytes seed(const std::string& name) { return seeds().at(name); }

void put(Bytes& bytes, std::size_t at, std::initializer_list<unsigned> values) {
  for (unsigned value : values) bytes.at(at++) = static_cast<std::byte>(value);
}

/// Where `text` ends in `bytes`.
std::size_t behind(const Bytes& bytes, std::string_view text) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t at = all.find(text);
  EXPECT_NE(at, all.npos) << text;
  return at + text.size();
}

/// Bytes at the end that no pixel needs and that the reader does not ask for.
std::size_t dispensable_tail(const std::string& name) {
  if (name == "rgb.bmp") return 1;      // rows are filled up to 4 bytes, the last one too
  if (name == "palette.bmp") return 3;  // likewise
  return 0;
}

TEST(BrokenFiles, EverySeedIsAPicture) {
  ASSERT_GE(seeds().size(), 18u);
  for (const auto& [name, bytes] : seeds()) EXPECT_EQ(error_of(bytes), "no error") << name;
}

TEST(BrokenFiles, CutAnywhereIsOneClearLine) {
  for (const auto& [name, bytes] : seeds()) {
    for (std::size_t size = 0; size < bytes.size() - dispensable_tail(name); ++size) {
      const std::string error = error_of(std::span(bytes).first(size));
      ASSERT_THAT(error, ::testing::StartsWith("file: ")) << name << " cut to " << size;
      ASSERT_THAT(error, ::testing::Not(::testing::HasSubstr("\n")));
    }
  }
}

// The decoders read ahead in pieces; a cut in a later piece must be seen as well.
TEST(BrokenFiles, CutLargePictures) {
  Image image(150, 90);
  std::mt19937 random(7);
  for (Rgb& c : image.pixels) {
    c = Rgb(static_cast<float>(random() % 1000), static_cast<float>(random() % 1000), 1.0f) / 1e3f;
  }
  const WriteOptions options;
  for (const Bytes& bytes :
       {codec::encode_exr(image, options, "file"), codec::encode_png(image, options, "file"),
        codec::encode_hdr(image, options), codec::encode_pfm(image)}) {
    ASSERT_EQ(error_of(bytes), "no error");
    for (std::size_t size = 0; size < bytes.size(); size += 64) {
      ASSERT_THAT(error_of(std::span(bytes).first(size)), ::testing::StartsWith("file: ")) << size;
    }
  }
}

TEST(BrokenFiles, EmptyAndGarbage) {
  EXPECT_EQ(error_of(""), "file: the file is empty");
  EXPECT_THAT(error_of("This is a text and no picture, whatever its name may be.\n"),
              ::testing::HasSubstr("no picture that can be read"));
  EXPECT_THAT(error_of("PFAU"), ::testing::StartsWith("file: "));
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    Bytes bytes(1 + random() % 400);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    EXPECT_THAT(error_of(bytes), ::testing::StartsWith("file: ")) << i;
  }
}

TEST(BrokenFiles, MissingFilesAndFolders) {
  EXPECT_THROW(read_image("/nowhere/a.exr"), Error);
  EXPECT_THROW(read_image("/"), Error);
  EXPECT_THROW(read_metadata("/nowhere/a.exr"), Error);
}

TEST(BrokenFiles, ClaimsThatTheFileCannotHold) {
  EXPECT_THAT(error_of("PF\n16384 16384\n-1.0\nabcd"), ::testing::HasSubstr("needs 3221225472"));
  EXPECT_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\nabcd"),
              ::testing::HasSubstr("cannot hold a picture of 16384x16384"));

  Bytes tga = seed("runs.tga");
  put(tga, 12, {0, 64, 0, 64});
  EXPECT_THAT(error_of(tga), ::testing::HasSubstr("cannot hold a picture of 16384x16384"));

  Bytes bmp = seed("rgb.bmp");
  put(bmp, 18, {0, 64, 0, 0, 0, 64, 0, 0});
  EXPECT_THAT(error_of(bmp), ::testing::HasSubstr("cannot hold a picture of 16384x16384"));

  Bytes jpeg = seed("baseline.jpg");
  put(jpeg, behind(jpeg, "\xff\xc0") + 3, {64, 0, 64, 0});
  EXPECT_THAT(error_of(jpeg), ::testing::HasSubstr("cannot hold a picture of 16384x16384"));

  Bytes png = seed("rgb.png");
  put(png, 16, {0, 0, 64, 0, 0, 0, 64, 0, 8, 2, 0, 0, 0, 0x26, 0xaa, 0x87, 0xd3});  // with its CRC
  EXPECT_THAT(error_of(png), ::testing::HasSubstr("cannot hold a picture of 16384x16384"));

  Bytes chunk = seed("rgb.png");
  put(chunk, behind(chunk, "tEXt") - 8, {0x40, 0, 0, 0});
  EXPECT_THAT(error_of(chunk), ::testing::HasSubstr("a PNG chunk of 1073741824 bytes"));

  Bytes exr = seed("half.exr");
  put(exr, behind(exr, std::string_view("dataWindow\0box2i\0\x10\0\0\0", 21)) + 8,
      {0xff, 0x3f, 0, 0, 0xff, 0x3f, 0, 0});
  EXPECT_THAT(error_of(exr), ::testing::HasSubstr("cannot hold a picture of 16384x16384"));
}

TEST(BrokenFiles, MorePixelsThanTheLimit) {
  EXPECT_THAT(error_of("PF\n16384 16385\n-1.0\nabcd"), ::testing::HasSubstr("too many pixels"));
  EXPECT_THAT(error_of("PF\n2147483647 2147483647\n-1.0\n"), ::testing::HasSubstr("too many"));
  EXPECT_THAT(error_of("PF\n0 4\n-1.0\n"), ::testing::HasSubstr("no pixels"));
  EXPECT_THAT(error_of("PF\n-3 4\n-1.0\n"), ::testing::HasSubstr("no pixels"));
  EXPECT_THAT(error_of("PF\n99999999999 4\n-1.0\n"), ::testing::HasSubstr("no number"));

  Bytes bmp = seed("rgb.bmp");
  put(bmp, 22, {0, 0, 0, 0x80});
  EXPECT_THAT(error_of(bmp), ::testing::StartsWith("file: "));
}

TEST(BrokenFiles, ExrHeadersThatLie) {
  constexpr std::string_view kWindow("dataWindow\0box2i\0\x10\0\0\0", 21);
  Bytes overflowing = seed("half.exr");
  put(overflowing, behind(overflowing, kWindow),
      {0, 0, 0, 0x80, 0, 0, 0, 0x80, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f});
  EXPECT_THAT(error_of(overflowing), ::testing::StartsWith("file: "));

  Bytes inverted = seed("half.exr");
  put(inverted, behind(inverted, kWindow), {9, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_THAT(error_of(inverted), ::testing::StartsWith("file: "));

  Bytes attribute = seed("half.exr");
  put(attribute, behind(attribute, std::string_view("lantern.passes\0string\0", 22)),
      {0xff, 0xff, 0xff, 0x7f});
  EXPECT_THAT(error_of(attribute), ::testing::HasSubstr("attribute of 2147483647 bytes"));
  EXPECT_THROW(codec::exr_metadata(attribute, "file"), Error);

  // OpenEXR reads one byte all the same and would go on with the wrong one.
  Bytes length = seed("half.exr");
  put(length, behind(length, std::string_view("lineOrder\0lineOrder\0", 20)), {2});
  EXPECT_THAT(error_of(length), ::testing::HasSubstr("attribute of type lineOrder has 2 bytes"));

  const auto flagged = [](unsigned flags) {
    Bytes bytes = seed("half.exr");
    put(bytes, 5, {flags});
    return error_of(bytes);
  };
  EXPECT_THAT(flagged(0x02), ::testing::HasSubstr("tile"));
  EXPECT_THAT(flagged(0x08), ::testing::HasSubstr("deep"));
  EXPECT_THAT(flagged(0x10), ::testing::HasSubstr("several parts"));

  Bytes colourless = seed("half.exr");
  put(colourless, behind(colourless, "chlist") + 5, {'X'});
  EXPECT_THAT(error_of(colourless), ::testing::HasSubstr("neither channels R, G, B nor Y"));
}

TEST(BrokenFiles, MetadataOfABrokenPng) {
  const Bytes png = seed("rgb.png");
  EXPECT_THROW(codec::png_metadata(std::span(png).first(60), "file"), Error);
}

TEST(Fuzz, SeedsAndTheirMutations) {
  std::mt19937 random(3);
  for (const auto& [name, bytes] : seeds()) {
    std::vector<std::uint8_t> data(bytes.size());
    std::memcpy(data.data(), bytes.data(), bytes.size());
    EXPECT_EQ(LLVMFuzzerTestOneInput(data.data(), data.size()), 0);
    for (int i = 0; i < 100; ++i) {
      std::vector<std::uint8_t> mutated = data;
      mutated[random() % mutated.size()] = static_cast<std::uint8_t>(random());
      EXPECT_EQ(LLVMFuzzerTestOneInput(mutated.data(), mutated.size()), 0);
    }
  }
}

}  // namespace
}  // namespace lantern
