// SPDX-License-Identifier: MIT
// The fuzzers' entries over their seeds and over the seeds' beginnings.
#include "lantern/core/file.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>

// The build gives each fuzzer's LLVMFuzzerTestOneInput the name of its file.
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
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      entry(reinterpret_cast<const std::uint8_t*>(bytes.data()), size);
    }
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(OgreFuzzSeeds, Binary) { run("ogre_binary", ogre_binary_fuzz); }
TEST(OgreFuzzSeeds, Material) { run("ogre_material", ogre_material_fuzz); }
TEST(OgreFuzzSeeds, Scene) { run("ogre_scene", ogre_scene_fuzz); }
TEST(OgreFuzzSeeds, Xml) { run("ogre_xml", ogre_xml_fuzz); }

}  // namespace
}  // namespace lantern
