// SPDX-License-Identifier: MIT
// The fuzzers' entries over their seeds and over the seeds' beginnings.
#include "lantern/core/file.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>

// The build gives each fuzzer's LLVMFuzzerTestOneInput the name of its file.
extern "C" int assimp_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int image_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int lights_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int ogre_binary_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int ogre_material_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int ogre_scene_fuzz(const std::uint8_t* data, std::size_t size);
extern "C" int ogre_xml_fuzz(const std::uint8_t* data, std::size_t size);

namespace lantern {
namespace {

void run(const char* seeds, int (*entry)(const std::uint8_t*, std::size_t)) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(
           std::filesystem::path(LANTERN_SOURCE_DIR) / "fuzz/seeds" / seeds)) {
    const auto bytes = read_file(file.path());
    // Small seeds at every byte; large ones at as many places as take a moment.
    constexpr std::size_t kPlaces = 512;
    const std::size_t step = 1 + bytes.size() / kPlaces;
    for (std::size_t size = 0; size < bytes.size(); size += step) {
      entry(reinterpret_cast<const std::uint8_t*>(bytes.data()), size);
    }
    entry(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(FuzzSeeds, Assimp) { run("assimp", assimp_fuzz); }
TEST(FuzzSeeds, Image) { run("image", image_fuzz); }
TEST(FuzzSeeds, Lights) { run("lights", lights_fuzz); }
TEST(FuzzSeeds, OgreBinary) { run("ogre_binary", ogre_binary_fuzz); }
TEST(FuzzSeeds, OgreMaterial) { run("ogre_material", ogre_material_fuzz); }
TEST(FuzzSeeds, OgreScene) { run("ogre_scene", ogre_scene_fuzz); }
TEST(FuzzSeeds, OgreXml) { run("ogre_xml", ogre_xml_fuzz); }

}  // namespace
}  // namespace lantern
