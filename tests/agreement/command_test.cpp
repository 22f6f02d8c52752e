// SPDX-License-Identifier: MIT
// The built command as its users meet it: exit codes, one-line errors, files whole or not at all.
#include "lantern/core/file.h"
#include "lantern/image/read.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <sys/wait.h>

namespace lantern::test {
namespace {

using Json = nlohmann::json;

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Command : public testing::Test {
 protected:
  /// Runs `prefix lantern ARGUMENTS` in a folder of its own.
  Outcome run(const std::string& arguments, const std::string& prefix = "") {
    const std::string line = "cd " + folder_.path().string() + " && " + prefix + " " +
                             LANTERN_COMMAND + " " + arguments + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "out.txt"),
            read_text(folder_ / "err.txt")};
  }

  void expect_error(const std::string& arguments, int code, const std::string& text) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()),
                      std::filesystem::directory_iterator()));
  }

  const TemporaryFolder folder_;
  const std::string box_ = std::string(LANTERN_SOURCE_DIR) + "/scenes/cornell_box.scene";
  const std::string small_ = " --size 24x16 --lights 16 --quiet ";
};

TEST_F(Command, RendersEveryFormatWithTheSamePicture) {
  for (const char* name : {"a.exr", "a.pfm", "a.hdr", "a.png"}) {
    const Outcome outcome = run("render " + box_ + small_ + "-o " + name);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "") << "quiet";
    const Image image = read_image(folder_ / name);
    EXPECT_EQ(image.width, 24) << name;
    EXPECT_EQ(image.height, 16) << name;
  }
  EXPECT_EQ(read_metadata(folder_ / "a.exr").at("lights"), "16");
  EXPECT_EQ(read_metadata(folder_ / "a.png").at("scene"), "cornell_box.scene");
}

TEST_F(Command, TellsItsStatisticsAsJson) {
  const Json json = Json::parse(run("render " + box_ + small_ + "-o a.pfm --json").out);
  for (const char* key : {"lights", "paths", "shadow_rays", "seconds_load", "seconds_lights",
                          "seconds_gather", "seconds_total", "peak_bytes"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["paths"], 16);
  EXPECT_GT(json["shadow_rays"], 0);
  const Json info = Json::parse(run("info " + box_ + " --json").out);
  EXPECT_EQ(info["triangles"], 32);
  EXPECT_NEAR(info["emitters"][0]["area"].get<double>(), 1.3 * 1.05, 1e-5);  // of floats near 5
  const Json same = Json::parse(run("compare a.pfm a.pfm --json").out);
  EXPECT_EQ(same["rmse"], 0.0);
  EXPECT_EQ(same["relmse"], 0.0);
  EXPECT_EQ(same["mean_a"], same["mean_b"]);
}

TEST_F(Command, RendersFromTheLightsItWrote) {
  ASSERT_EQ(run("lights " + box_ + " --lights 16 -o l.json").code, 0);
  ASSERT_EQ(run("render " + box_ + small_ + "-o a.pfm").code, 0);
  ASSERT_EQ(run("render " + box_ + small_ + "-o b.pfm --lights-from l.json").code, 0);
  EXPECT_EQ(read_text(folder_ / "a.pfm"), read_text(folder_ / "b.pfm"));
  EXPECT_EQ(run("lights " + box_ + " -o l.ply").code, 0);
  EXPECT_EQ(run("lights " + box_ + " -o l.gltf").code, 0);
}

TEST_F(Command, RefusesWrongUsageWithTwo) {
  expect_error("", 2, "subcommand");
  expect_error("render", 2, "scene");
  expect_error("render " + box_ + " -o a.exr --size 0x4", 2, "--size");
  expect_error("render " + box_ + " -o a.exr --reflectivity 1", 2, "--reflectivity");
  expect_error("render " + box_ + " -o a.exr --emitter nothing", 2, "--emitter");
  expect_error("render " + box_ + " -o a.exr --look-at 1,2", 2, "--look-at");
  expect_error("render " + box_ + " -o a.exr --method path", 2, "path");
  expect_error("render " + box_ + " -o a.exr --backend gl", 2, "gl");
  expect_error("view " + box_, 2, "view");
  expect_error("render " + box_ + " -o a.exr --no-such-option", 2, "no-such-option");
}

TEST_F(Command, SaysWhatIsWrongWithOneAndLeavesNothing) {
  run("--version");
  const std::size_t before = files();
  expect_error("render missing.obj -o a.exr", 1, "missing.obj");
  expect_error("render " + box_ + small_ + "-o a.gif", 1, "a.gif");
  expect_error("render " + box_ + small_ + "-o nowhere/a.exr", 1, "nowhere/a.exr");
  expect_error("render " + box_ + small_ + "-o /dev/full", 1, "/dev/full");
  expect_error("render " + box_ + small_ + "-o a.exr --camera other", 1, "other");
  expect_error("render " + box_ + small_ + "-o a.exr --emitter 'none*=1,1,1'", 1, "none*");
  expect_error("compare a.exr b.exr", 1, "a.exr");
  EXPECT_EQ(files(), before);
  write_file(folder_ / "dark.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  expect_error("render dark.obj -o a.exr", 1, "--emitter");
  EXPECT_EQ(files(), before + 1);
}

TEST_F(Command, RefusesCutAndForeignScenes) {
  const std::string xml =
      read_text(std::string(LANTERN_SOURCE_DIR) + "/scenes/cornell_box.mesh.xml");
  for (const char* name :
       {"a.mesh.xml", "a.mesh", "a.scene", "a.gltf", "a.glb", "a.obj", "a.ply"}) {
    write_file(folder_ / name, std::string_view(xml).substr(0, xml.size() / 2));
    expect_error(std::string("info ") + name, 1, name);
    write_file(folder_ / name, std::string_view());
    expect_error(std::string("info ") + name, 1, name);
  }
}

TEST_F(Command, WritesWhatIsThereWhenInterrupted) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = run(
      "render " + box_ + " -o a.pfm --size 64x64 --lights 64 --passes 1000000", "timeout -s INT 2");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_NE(outcome.err.find("stopped early"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_image(folder_ / "a.pfm").width, 64);
  // A million passes take hours; a busy machine may need a while to end one.
  EXPECT_LT(took.count(), 60.0);
}

TEST_F(Command, KeepsToItsTime) {
  const Outcome outcome =
      run("render " + box_ + " -o a.pfm --size 64x64 --time 1 --lights 16 --quiet --json");
  ASSERT_EQ(outcome.code, 0);
  const Json json = Json::parse(outcome.out);
  EXPECT_GT(json["passes"], 1);
}

}  // namespace
}  // namespace lantern::test
