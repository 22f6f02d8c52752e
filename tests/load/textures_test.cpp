// SPDX-License-Identifier: MIT
#include "lantern/load/textures.h"

#include "tests/load/load_files.h"

namespace lantern::test {
namespace {

class TextureCacheTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  Scene scene;
  LoadReport report;
  TextureCache cache{scene, report};
  const std::string png = from_base64(kPng64);
};

TEST_F(TextureCacheTest, ReadsAPicture) {
  write_file(folder / "a.png", png);
  const auto id = cache.load(folder / "a.png", Wrap::kClamp, Wrap::kMirror);
  ASSERT_TRUE(id);
  const Texture& texture = scene.textures.at(index(*id));
  EXPECT_EQ(texture.width, 2);
  EXPECT_EQ(texture.height, 2);
  EXPECT_EQ(texture.wrap_u, Wrap::kClamp);
  EXPECT_EQ(texture.wrap_v, Wrap::kMirror);
  EXPECT_THAT(texture.srgb8, ::testing::ElementsAre(255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 128,
                                                    255, 255, 255, 255));
  EXPECT_TRUE(texture.linear.empty());
}

TEST_F(TextureCacheTest, ReadsEachFileOncePerWrapping) {
  write_file(folder / "a.png", png);
  std::filesystem::create_directory(folder / "sub");
  const auto first = cache.load(folder / "a.png", Wrap::kRepeat, Wrap::kRepeat);
  EXPECT_EQ(cache.load(folder / "sub/../a.png", Wrap::kRepeat, Wrap::kRepeat), first);
  EXPECT_NE(cache.load(folder / "a.png", Wrap::kClamp, Wrap::kRepeat), first);
  EXPECT_EQ(scene.textures.size(), 2u);
}

TEST_F(TextureCacheTest, AMissingFileIsAVisibleCheckerAndOneWarning) {
  const auto id = cache.load(folder / "none.png", Wrap::kRepeat, Wrap::kRepeat);
  EXPECT_EQ(cache.load(folder / "none.png", Wrap::kRepeat, Wrap::kRepeat), id);
  EXPECT_NE(cache.load(folder / "none.png", Wrap::kClamp, Wrap::kClamp), id);
  EXPECT_THAT(report.warnings, ::testing::ElementsAre(::testing::HasSubstr("none.png")));
  const Texture& texture = scene.textures.at(index(id.value()));
  ASSERT_GE(texture.srgb8.size(), 8u);
  EXPECT_THAT(std::vector(texture.srgb8.begin(), texture.srgb8.begin() + 8),
              ::testing::ElementsAre(255, 0, 255, 255, 0, 0, 0, 255));
}

TEST_F(TextureCacheTest, WhatIsNoPictureIsAnErrorWithThePath) {
  write_file(folder / "a.png", "this is no picture");
  write_file(folder / "empty.png", "");
  for (const auto& path : {folder / "a.png", folder / "empty.png", folder.path()}) {
    try {
      cache.load(path, Wrap::kRepeat, Wrap::kRepeat);
      ADD_FAILURE() << path;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), ::testing::HasSubstr(path.string()));
    }
  }
  EXPECT_TRUE(scene.textures.empty());
}

TEST_F(TextureCacheTest, ReadsEmbeddedPictures) {
  const auto bytes = std::as_bytes(std::span(png));
  const auto id = cache.load_bytes(bytes, "a.glb: image 0", Wrap::kRepeat, Wrap::kRepeat);
  EXPECT_EQ(cache.load_bytes(bytes, "a.glb: image 0", Wrap::kRepeat, Wrap::kRepeat), id);
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].name, "a.glb: image 0");
  EXPECT_THROW(cache.load_bytes(bytes.first(20), "cut", Wrap::kRepeat, Wrap::kRepeat), Error);
}

TEST_F(TextureCacheTest, NothingIsNoTexture) {
  EXPECT_EQ(cache.load({}, Wrap::kRepeat, Wrap::kRepeat), std::nullopt);
  EXPECT_EQ(cache.load_bytes({}, "nothing", Wrap::kRepeat, Wrap::kRepeat), std::nullopt);
}

}  // namespace
}  // namespace lantern::test
