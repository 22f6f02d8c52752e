// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/core/math.h"
#include "lantern/core/parallel.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>
#include <sys/stat.h>
#include <thread>
#include <vector>

namespace lantern {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

// --- Errors
// ----------------------------------------------------------------------------------------

TEST(Error, StartsWithThePlace) {
  EXPECT_STREQ(Error({"f"}, "is bad").what(), "f: is bad");
  EXPECT_STREQ(Error({"f", 3}, "is bad").what(), "f:3: is bad");
  EXPECT_STREQ(Error({"f", 3, 7}, "is bad").what(), "f:3:7: is bad");
  EXPECT_STREQ(Error({.file = "f", .byte = 12}, "is bad").what(), "f: byte 12: is bad");
  EXPECT_STREQ(Error("plain").what(), "plain");
}

TEST(Error, IsOneLineWhateverItIsMadeOf) {
  EXPECT_STREQ(Error({"a\nb"}, "x\r\ny\tz\x1b[31m\n\n").what(), "a b: x  y z [31m");
}

TEST(Error, FailFormats) {
  try {
    fail({"f", 1}, "{} of {}", 2, "three");
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "f:1: 2 of three");
  }
}

// --- Files
// -----------------------------------------------------------------------------------------

std::string error_of(const std::function<void()>& work) {
  try {
    work();
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::size_t entries(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

TEST(File, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  for (const std::string& text :
       {std::string(), std::string("a\0b\r\n", 5), std::string(1 << 20, 'x')}) {
    write_file(folder / "f", text);
    EXPECT_EQ(read_text(folder / "f"), text);
    const auto bytes = read_file(folder / "f");
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), text);
  }
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(File, WritingLeavesTheOldFileUntilTheNewOneIsWhole) {
  const TemporaryFolder folder;
  write_file(folder / "f", "old");
  std::filesystem::create_hard_link(folder / "f", folder / "also_old");
  write_file(folder / "f", "new");
  EXPECT_EQ(read_text(folder / "f"), "new");
  EXPECT_EQ(read_text(folder / "also_old"), "old");  // replaced, not written into
}

TEST(File, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  const auto write = [](const std::filesystem::path& path) {
    return error_of([&] { write_file(path, "text"); });
  };
  EXPECT_THAT(write("/dev/full"), HasSubstr("/dev/full: cannot be written: No space left"));
  EXPECT_THAT(write(folder / "none/f"), HasSubstr("none/f: cannot be written: No such file"));
  EXPECT_THAT(write(folder.path()), HasSubstr("is a folder"));
  EXPECT_NE(write(""), "");
  EXPECT_NE(write(folder / ""), "");
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(File, DevicesAreWrittenInto) {
  write_file("/dev/null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(File, ReadsOnlyRegularFiles) {
  const TemporaryFolder folder;
  const auto read = [](const std::filesystem::path& path) {
    return error_of([&] { read_file(path); });
  };
  EXPECT_THAT(read(folder / "none"), ::testing::EndsWith("none: no such file"));
  EXPECT_THAT(read(folder / "none/below"), HasSubstr("no such file"));
  EXPECT_THAT(read(folder.path()), HasSubstr("is not a file"));
  EXPECT_THAT(read("/dev/zero"), HasSubstr("is not a file"));
  // A pipe without a writer would make reading wait for ever.
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(read(folder / "pipe"), HasSubstr("is not a file"));
  write_file(folder / "f", "x");
  EXPECT_NE(read(folder / "f/below"), "");
}

TEST(File, RefusesFilesNoOneMeansToLoad) {
  const TemporaryFolder folder;
  std::ofstream(folder / "huge").put('x');
  std::filesystem::resize_file(folder / "huge", (std::uintmax_t{4} << 30) + 1);  // sparse
  EXPECT_THAT(error_of([&] { read_file(folder / "huge"); }), HasSubstr("the limit is"));
}

TEST(File, RequireWritableLeavesNothing) {
  const TemporaryFolder folder;
  require_writable(folder / "f");
  EXPECT_EQ(entries(folder.path()), 0u);
  write_file(folder / "f", "kept");
  require_writable(folder / "f");
  EXPECT_EQ(read_text(folder / "f"), "kept");
  EXPECT_NE(error_of([&] { require_writable(folder / "none/f"); }), "");
  EXPECT_NE(error_of([&] { require_writable(folder.path()); }), "");
}

TEST(File, ExtensionIsLowerCase) {
  EXPECT_EQ(extension("a/b.EXR"), ".exr");
  EXPECT_EQ(extension("a.mesh.xml"), ".xml");
  EXPECT_EQ(extension("a.b/c"), "");
  EXPECT_EQ(extension(".hidden"), "");
  EXPECT_EQ(extension(""), "");
}

// --- Parallel loops
// --------------------------------------------------------------------------------

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{10007}}) {
    std::vector<int> calls(count, 0);
    parallel_for(count, 16, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
  }
}

TEST(ParallelFor, PassesExceptionsOn) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t i) {
                              if (i == 50) throw Error("stop");
                            }),
               Error);
}

/// Threads that take part in a loop whose bodies wait long enough for each to get one.
std::size_t threads_used() {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  parallel_for(64, 1, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  return ids.size();
}

TEST(ThreadScope, BoundsTheThreads) {
  for (const int threads : {1, 2, 5}) {
    ThreadScope scope(threads);
    std::size_t used = 0;
    scope.run([&] { used = threads_used(); });
    EXPECT_LE(used, static_cast<std::size_t>(threads));
    EXPECT_GE(used, 1u);
  }
}

TEST(ThreadScope, HonoursMoreThreadsThanCores) {
  const unsigned cores = std::thread::hardware_concurrency();
  ThreadScope scope(static_cast<int>(cores) + 3);
  std::size_t used = 0;
  scope.run([&] { used = threads_used(); });
  EXPECT_GT(used, cores);
}

TEST(ThreadScope, RunPassesExceptionsOn) {
  ThreadScope scope(2);
  EXPECT_THROW(scope.run([] { throw Error("stop"); }), Error);
}

// --- Mathematics
// -----------------------------------------------------------------------------------

TEST(Frame, IsRightHandedAndOrthonormal) {
  std::vector<Vec3> normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, -0.0f}};
  for (int i = 0; i < 1000; ++i) {
    const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 1000.0f;
    const float phi = 2.399963f * static_cast<float>(i);  // the golden angle
    const float r = std::sqrt(1.0f - z * z);
    normals.push_back({r * std::cos(phi), r * std::sin(phi), z});
  }
  normals.push_back(glm::normalize(Vec3(1e-4f, -1e-4f, -1.0f)));
  for (const Vec3& n : normals) {
    const Frame frame(n);
    constexpr float kRounding = 2e-6f;
    EXPECT_NEAR(glm::length(frame.tangent), 1.0f, kRounding);
    EXPECT_NEAR(glm::length(frame.bitangent), 1.0f, kRounding);
    EXPECT_NEAR(glm::dot(frame.tangent, n), 0.0f, kRounding);
    EXPECT_NEAR(glm::dot(frame.bitangent, n), 0.0f, kRounding);
    EXPECT_NEAR(glm::dot(frame.tangent, frame.bitangent), 0.0f, kRounding);
    EXPECT_NEAR(glm::dot(glm::cross(frame.tangent, frame.bitangent), n), 1.0f, kRounding);
    EXPECT_EQ(frame.to_world({0, 0, 1}), n);
  }
}

TEST(Bounds, GrowWithTheirPoints) {
  Bounds bounds;
  EXPECT_TRUE(bounds.empty());
  EXPECT_EQ(bounds.radius(), 0.0f);
  bounds.add({1, 2, 3});
  EXPECT_FALSE(bounds.empty());
  EXPECT_EQ(bounds.radius(), 0.0f);
  bounds.add({3, 2, 3});
  EXPECT_EQ(bounds.centre(), Vec3(2, 2, 3));
  EXPECT_EQ(bounds.radius(), 1.0f);
}

TEST(Colour, LuminanceOfWhiteIsOne) {
  EXPECT_FLOAT_EQ(luminance(Rgb(1)), 1.0f);
  EXPECT_EQ(max_component({1, 3, 2}), 3.0f);
  EXPECT_EQ(mean_component({1, 3, 2}), 2.0f);
  EXPECT_TRUE(is_black(Rgb(0)));
  EXPECT_FALSE(is_black({0, 0, 1e-30f}));
}

}  // namespace
}  // namespace lantern
