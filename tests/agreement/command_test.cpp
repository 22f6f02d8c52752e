// SPDX-License-Identifier: MIT
// The command as its users meet it: what it writes, what it says and how it exits.
#include "lantern/core/file.h"
#include "lantern/image/compare.h"
#include "lantern/image/flip.h"
#include "lantern/image/read.h"
#include "lantern/image/write.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace lantern {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::duration;
using testing::HasSubstr;
using testing::IsSupersetOf;

/// How much longer than asked a command may take: starting it, writing, and a machine that has
/// much else to do. Only what would hang, or render to the end, exceeds it.
#ifdef LANTERN_SANITIZED
constexpr double kPatience = 120.0;
#else
constexpr double kPatience = 20.0;
#endif

/// A limit of this process and those that it starts, while it lives.
class LimitScope {
 public:
  using Resource = decltype(RLIMIT_AS);
  LimitScope(Resource what, rlim_t limit) : what_(what) {
    ::getrlimit(what, &before_);
    const rlimit now{limit, before_.rlim_max};
    ::setrlimit(what, &now);
  }
  ~LimitScope() { ::setrlimit(what_, &before_); }
  LimitScope(const LimitScope&) = delete;
  LimitScope& operator=(const LimitScope&) = delete;

 private:
  Resource what_;
  rlimit before_{};
};

class CommandTest : public testing::Test {
 protected:
  struct Outcome {
    int code = -1;  // of exit; 128 and the signal if one ended it
    std::string out, err;
    double seconds = 0.0;
  };

  /// A command under way.
  struct Running {
    pid_t process;
    Clock::time_point start;
  };

  Running start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), LANTERN_COMMAND);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string out = (folder_ / "stdout").string(), err = (folder_ / "stderr").string();
    const Running running{::fork(), Clock::now()};
    if (running.process == 0) {
      const auto into = [](const std::string& name, int descriptor) {
        constexpr mode_t kMine = 0600;
        ::dup2(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMine), descriptor);
      };
      into(out, STDOUT_FILENO);
      into(err, STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    return running;
  }

  Outcome finish(const Running& running) const {
    int status = 0;
    ::waitpid(running.process, &status, 0);
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.seconds = duration<double>(Clock::now() - running.start).count();
    outcome.out = read_text(folder_ / "stdout");
    outcome.err = read_text(folder_ / "stderr");
    return outcome;
  }

  Outcome run(std::vector<std::string> arguments) const {
    return finish(start(std::move(arguments)));
  }

  /// A small render of the furnace, or of `scene`, to `out`.
  std::vector<std::string> render(const std::string& out, std::vector<std::string> more = {},
                                  const std::string& scene = "furnace.scene") const {
    std::vector<std::string> arguments = {"render", own(scene), "-o",       path(out),
                                          "--size", "24x16",    "--lights", "16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// The furnace to a.pfm by a radiosity method.
  std::vector<std::string> radiosity(const std::string& method,
                                     std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "render",   own("furnace.scene"), "-o", path("a.pfm"), "--size", "24x16",
        "--method", "radiosity-" + method};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string own(const std::string& name) {
    return (fs::path(LANTERN_SOURCE_DIR) / "scenes" / name).string();
  }

  /// Exit code `code`, one line on standard error that holds `what`, nothing on standard output.
  static void expect_failure(const Outcome& outcome, int code, const std::string& what = "") {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::StartsWith("lantern: "));
    EXPECT_THAT(outcome.err, testing::EndsWith("\n"));
    EXPECT_THAT(outcome.err, HasSubstr(what));
    EXPECT_EQ(outcome.out, "");
  }

  /// What lies in the folder beside what the command said.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      if (name != "stdout" && name != "stderr") names.push_back(name);
    }
    return names;
  }

  static std::vector<std::string> keys(const nlohmann::json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(CommandTest, RendersToEveryFormat) {
  for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"}) {
    const Outcome outcome = run(render(name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    const Image image = read_image(folder_ / name);
    EXPECT_EQ(image.width, 24);
    EXPECT_EQ(image.height, 16);
    EXPECT_FALSE(is_black(image.at(12, 8))) << name;
  }
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.exr", "a.png", "a.hdr", "a.pfm"));
}

TEST_F(CommandTest, WritesItsOptionsIntoThePicture) {
  for (const char* name : {"a.exr", "a.png"}) {
    ASSERT_EQ(run(render(name, {"--seed", "5", "--passes", "2"})).code, 0);
    const Metadata metadata = read_metadata(folder_ / name);
    EXPECT_THAT(metadata, IsSupersetOf(Metadata{{"scene", "furnace.scene"},
                                                {"method", "instant-radiosity"},
                                                {"lights", "16"},
                                                {"passes", "2"},
                                                {"seed", "5"}}));
    ASSERT_TRUE(metadata.contains("software"));
    EXPECT_THAT(metadata.at("software"), testing::StartsWith("lantern "));
  }
}

TEST_F(CommandTest, RenderTellsStatisticsAsJson) {
  const Outcome outcome = run(render("a.pfm", {"--json", "--passes", "2"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(keys(json),
              IsSupersetOf({"lights", "paths", "shadow_rays", "seconds_load", "seconds_lights",
                            "seconds_gather", "seconds_total", "peak_bytes"}));
  EXPECT_EQ(json["paths"], 32);
  EXPECT_GE(json["lights"], 32);
  EXPECT_GT(json["shadow_rays"], 0);
  EXPECT_GE(json["seconds_total"], json["seconds_gather"]);
  EXPECT_GT(json["peak_bytes"], 1 << 20);
}

TEST_F(CommandTest, TracesPathsAndWritesTheirVariance) {
  const std::vector<std::string> arguments = {"render",     own("cornell_box.scene"),
                                              "-o",         path("a.exr"),
                                              "--size",     "24x16",
                                              "--method",   "path",
                                              "--json",     "--seed",
                                              "3",          "--samples",
                                              "4",          "--passes",
                                              "8",          "--variance",
                                              path("v.exr")};
  const Outcome outcome = run(arguments);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["lights"], 0);
  EXPECT_EQ(json["paths"], 24 * 16 * 4 * 8);
  EXPECT_EQ(json["passes"], 8);
  EXPECT_GT(json["shadow_rays"], 0);
  for (const char* name : {"a.exr", "v.exr"}) {
    EXPECT_THAT(read_metadata(folder_ / name),
                IsSupersetOf(Metadata{
                    {"method", "path"}, {"samples", "4"}, {"passes", "8"}, {"seed", "3"}}));
    EXPECT_FALSE(is_black(read_image(folder_ / name).at(12, 8))) << name;
  }
  EXPECT_TRUE(read_metadata(folder_ / "v.exr").contains("quantity"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.exr", "v.exr"));
}

TEST_F(CommandTest, RadiosityTellsStatisticsAsJson) {
#ifdef LANTERN_WITH_GL
  const std::vector<std::string> methods = {"hemicube", "progressive", "gpu"};
#else
  const std::vector<std::string> methods = {"hemicube", "progressive"};
#endif
  for (const std::string& method : methods) {
    const Outcome outcome =
        run(radiosity(method, {"--json", "--patches", "100", "--hemicube", "32"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_GT(json["patches"], 10);
    EXPECT_LE(json["patches"], 100);
    EXPECT_GE(json["elements"], json["patches"]);
    EXPECT_GE(json["hemicubes"], json["patches"]);
    if (method == "hemicube") {
      EXPECT_NEAR(json["row_sums"][1], 1.0, 1e-6);
      EXPECT_LT(json["reciprocity_error"], 1.0);
      EXPECT_GT(json["sweeps"], 1);
    } else {
      EXPECT_GT(json["shots"], 10);
      EXPECT_LE(json["unshot_share"], 1e-3);
      EXPECT_LT(json["conservation_error"], 1e-6);
    }
    const Image image = read_image(folder_ / "a.pfm");
    double mean = 0.0;
    for (const Rgb& pixel : image.pixels) {
      mean += static_cast<double>(pixel.g) / static_cast<double>(image.pixels.size());
    }
    EXPECT_NEAR(mean, 2.0, 0.02) << method;  // every pixel is 2, but for the grain of few patches
  }
}

#ifdef LANTERN_WITH_GL
TEST_F(CommandTest, HemicubesCanBeDrawnByGl) {
  const Outcome outcome = run(radiosity("hemicube", {"--patches", "100", "--backend", "gl"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const Rgb& pixel : read_image(folder_ / "a.pfm").pixels) EXPECT_NEAR(pixel.g, 2.0f, 0.1f);
  EXPECT_EQ(run(radiosity("progressive", {"--backend", "gl"})).code, 2);
}
#endif

TEST_F(CommandTest, TheMatrixTellsItsMemoryAndTimeBeforehandAndKeepsToTheMemory) {
  for (const std::string solver : {"gauss-seidel", "elimination"}) {
    const Outcome outcome =
        run(radiosity("matrix", {"--json", "--patches", "400", "--solver", solver}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("a matrix of"));
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_LE(json["patches"], 400);
    EXPECT_GT(json["seconds_expected"], 0.0);
    EXPECT_GT(json["seconds_matrix"], 0.0);
    const auto elements = json["elements"].get<std::uint64_t>();
    const std::uint64_t each = solver == "elimination" ? 12 : 4;
    EXPECT_EQ(json["bytes_expected"], each * elements * elements);
    // A convex room needs no rays, and its rows add up to 1 but for the cubatures' error.
    EXPECT_EQ(json["form_factor_rays"], 0);
    EXPECT_NEAR(json["row_sums"][0], 1.0, 1e-3);
    EXPECT_NEAR(json["row_sums"][2], 1.0, 1e-3);
    EXPECT_LT(json["reciprocity_error"], 1e-6);
    const Image image = read_image(folder_ / "a.pfm");
    for (const Rgb& pixel : image.pixels) EXPECT_NEAR(pixel.g, 2.0f, 4e-3f);
  }
}

TEST_F(CommandTest, RadiosityRefusesAMatrixLargerThanMemory) {
  for (const std::string method : {"hemicube", "matrix"}) {
    expect_failure(run(radiosity(method, {"--patches", "1000000"})), 1, "GB");
    expect_failure(run(radiosity(method, {"--patch-size", "0.0001"})), 1, "GB");
  }
}

TEST_F(CommandTest, RadiosityRefusesMorePatchesThanMemoryHolds) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "a sanitizer takes all address space there is";
#endif
  const LimitScope limit(RLIMIT_AS, rlim_t{4} << 30);
  expect_failure(run(radiosity("progressive", {"--patches", "4000000"})), 1, "GB");
  expect_failure(run(radiosity("progressive", {"--patch-size", "0.0005"})), 1, "take larger ones");
}

TEST_F(CommandTest, RadiosityRefusesSurfacesThatReflectAllLight) {
  std::ofstream(folder_ / "white.mtl") << "newmtl white\nKd 1 1 1\nKe 1 1 1\n";
  std::ofstream(folder_ / "white.obj") << "mtllib white.mtl\nusemtl white\n"
                                          "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  expect_failure(
      run({"render", path("white.obj"), "-o", path("a.pfm"), "--method", "radiosity-matrix"}), 1,
      "reflects all light");
}

TEST_F(CommandTest, RadiosityIgnoresSurfacesOfNoArea) {
  std::ofstream(folder_ / "flat.mtl") << "newmtl grey\nKd .5 .5 .5\nKe 1 1 1\n";
  std::ofstream(folder_ / "flat.obj") << "mtllib flat.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\n"
                                         "v 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n";
  const Outcome outcome = run({"render", path("flat.obj"), "-o", path("a.pfm"), "--size", "8x8",
                               "--method", "radiosity-matrix", "--patches", "20", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(nlohmann::json::parse(outcome.out)["patches"], 1);
}

TEST_F(CommandTest, ProgressiveRadiosityKeepsToItsTime) {
  const Outcome outcome =
      run({"render", own("cornell_box.scene"), "-o", path("a.exr"), "--time", "1", "--size",
           "64x64", "--json", "--method", "radiosity-progressive", "--cutoff", "0"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(outcome.seconds, 1.0 + kPatience);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["shots"], 0);
  EXPECT_LT(json["unshot_share"], 1.0);
}

TEST_F(CommandTest, CompareTellsDistancesAsJson) {
  ASSERT_EQ(run(render("a.pfm")).code, 0);
  ASSERT_EQ(run(render("b.pfm", {"--seed", "1"})).code, 0);
  const Outcome outcome = run({"compare", path("a.pfm"), path("b.pfm"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(keys(json), IsSupersetOf({"rmse", "relmse", "flip", "mean_a", "mean_b"}));
  const Comparison expected = compare(read_image(folder_ / "a.pfm"), read_image(folder_ / "b.pfm"));
  EXPECT_GT(expected.relmse, 0.0);
  EXPECT_EQ(json["rmse"], expected.rmse);
  EXPECT_EQ(json["relmse"], expected.relmse);
  EXPECT_EQ(json["flip"], flip(read_image(folder_ / "a.pfm"), read_image(folder_ / "b.pfm")).mean);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(json["mean_a"][static_cast<std::size_t>(channel)], expected.mean_a[channel]);
    EXPECT_EQ(json["mean_b"][static_cast<std::size_t>(channel)], expected.mean_b[channel]);
  }
  ASSERT_EQ(run({"render", own("furnace.scene"), "-o", path("small.pfm"), "--size", "8x8"}).code,
            0);
  expect_failure(run({"compare", path("a.pfm"), path("small.pfm")}), 1, "8x8");
}

TEST_F(CommandTest, CompareDrawsTheDifference) {
  write_image(folder_ / "a.pfm", Image(20, 12, Rgb(3.0f, 1.0f, 0.5f)));
  write_image(folder_ / "b.pfm", Image(20, 12, Rgb(1.0f, 2.0f, 0.5f)));
  const auto compare_to = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"compare", path("a.pfm"), path("b.pfm")});
    return run(more);
  };
  for (const char* name : {"d.exr", "d.pfm"}) {
    ASSERT_EQ(compare_to({"--difference", path(name)}).code, 0);
    EXPECT_EQ(read_image(folder_ / name).at(19, 11), Rgb(2.0f, -1.0f, 0.0f)) << name;
  }
  ASSERT_EQ(compare_to({"--difference", path("d.png"), "--flip-map", path("f.exr")}).code, 0);
  // Luminance 0.2126 * 2 - 0.7152: darker, so blue.
  const Rgb painted = read_image(folder_ / "d.png").at(0, 0);
  EXPECT_GT(painted.b, painted.r);
  const double whole = nlohmann::json::parse(compare_to({"--json"}).out)["flip"];
  const double dimmed = nlohmann::json::parse(
      compare_to({"--json", "--exposure", "-2", "--flip-map", path("g.exr")}).out)["flip"];
  EXPECT_NEAR(read_image(folder_ / "f.exr").at(10, 6).g, whole, 1e-6);
  EXPECT_NEAR(read_image(folder_ / "g.exr").at(10, 6).g, dimmed, 1e-6);
  EXPECT_GT(std::abs(whole - dimmed), 0.01);
  ASSERT_EQ(compare_to({"--flip-map", path("f.png")}).code, 0);
  EXPECT_EQ(read_image(folder_ / "f.png").width, 20);
  expect_failure(compare_to({"--difference", path("x.hdr")}), 1, "x.hdr");
  expect_failure(compare_to({"--flip-map", path("x.txt")}), 1, "x.txt");
  expect_failure(compare_to({"--difference", path("x.png"), "--difference-scale", "0"}), 2);
  expect_failure(compare_to({"--pixels-per-degree", "0"}), 2);
}

TEST_F(CommandTest, BakesWholeFilesOrNone) {
  const std::vector<std::string> command = {"bake", own("furnace.scene"), "--patches", "100"};
  const auto bake = [&](std::vector<std::string> more) {
    more.insert(more.begin(), command.begin(), command.end());
    return run(more);
  };
  const Outcome outcome = bake({"-o", path("a.glb"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(keys(json), IsSupersetOf({"patches", "shots", "unshot_share", "vertices", "triangles",
                                        "charts", "radiance_of_white", "bytes"}));
  EXPECT_LE(json["patches"], 100);
  EXPECT_EQ(json["bytes"], fs::file_size(folder_ / "a.glb"));
  EXPECT_EQ(run({"info", path("a.glb")}).code, 0);
  ASSERT_EQ(bake({"-o", path("v.glb"), "--bake", "vertices"}).code, 0);
  EXPECT_LT(fs::file_size(folder_ / "v.glb"), fs::file_size(folder_ / "a.glb"));
  fs::remove(folder_ / "a.glb");
  fs::remove(folder_ / "v.glb");

  expect_failure(bake({"-o", path("a.gltf")}), 1, "a.gltf");
  expect_failure(bake({"-o", path("no/folder/a.glb")}), 1, "no/folder");
  expect_failure(bake({"-o", path("a.glb"), "--lightmap", "4"}), 1, "lightmap");
  expect_failure(bake({"-o", path("a.glb"), "--lightmap", "0"}), 2, "--lightmap");
  expect_failure(bake({"-o", path("a.glb"), "--patch-size", "0"}), 2, "--patch-size");
  expect_failure(bake({"-o", path("a.glb"), "--bake", "paint"}), 2, "--bake");
  expect_failure(bake({}), 2, "--output");
  write_file(folder_ / "dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_failure(run({"bake", path("dark.obj"), "-o", path("a.glb")}), 1, "--emitter");
  EXPECT_THAT(files(), testing::ElementsAre("dark.obj"));
  if (!fs::exists("/dev/full")) return;
  fs::create_symlink("/dev/full", folder_ / "full.glb");
  expect_failure(bake({"-o", path("full.glb")}), 1, "full.glb");
}

TEST_F(CommandTest, WritesTheBakedWhenInterrupted) {
  const Running running = start({"bake", own("cornell_box.scene"), "-o", path("a.glb"), "--patches",
                                 "3000", "--cutoff", "1e-9", "--lightmap", "64"});
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ::kill(running.process, SIGINT);
  const Outcome outcome = finish(running);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("stopped early"));
  EXPECT_GT(fs::file_size(folder_ / "a.glb"), 0u);
}

TEST_F(CommandTest, MeasuresConvergence) {
  write_image(folder_ / "reference.pfm", Image(8, 6, Rgb(2.0f)));  // what the furnace's file says
  const auto bench = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "convergence", own("furnace.scene"), "--reference",
                               path("reference.pfm"), "--methods", "instant-radiosity"});
    return run(more);
  };
  const Outcome outcome =
      bench({"--lights", "16,64", "--seconds", "0.1", "-o", path("c.csv"), "-o", path("c.svg")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const std::string csv = read_text(folder_ / "c.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(csv, HasSubstr("\ninstant-radiosity,seconds,0.1,"));
  EXPECT_THAT(csv, HasSubstr("\ninstant-radiosity,lights,64,"));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 4);
  EXPECT_THAT(read_text(folder_ / "c.svg"), testing::StartsWith("<svg "));
  const Outcome computed = run({"bench", "convergence", own("furnace.scene"), "--reference-seconds",
                                "0.2", "--size", "8x6", "--lights", "64", "--quiet"});
  EXPECT_EQ(computed.code, 0) << computed.err;
  EXPECT_EQ(std::count(computed.out.begin(), computed.out.end(), '\n'), 2);
  expect_failure(bench({"--reference-seconds", "1"}), 2, "reference");
  expect_failure(bench({"-o", path("c.txt")}), 1, "c.txt");
  expect_failure(bench({"--lights", "0"}), 2, "--lights");
  expect_failure(bench({"--seconds", "1,soon"}), 2, "--seconds");
  expect_failure(
      run({"bench", "convergence", own("furnace.scene"), "--reference", path("none.exr")}), 1,
      "none.exr");
  expect_failure(run({"bench", "convergence", own("furnace.scene")}), 2, "--reference");
  expect_failure(run({"bench", "convergence", own("furnace.scene"), "--reference",
                      path("reference.pfm"), "--methods", "guess"}),
                 2, "guess");
  expect_failure(run({"bench"}), 2);
}

#ifdef LANTERN_WITH_GL
TEST_F(CommandTest, MeasuresFrames) {
  const auto bench = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "frames", own("cornell_box.scene"), "--size", "16x12",
                               "--seconds", "0.001"});
    return run(more);
  };
  const Outcome outcome = bench({"--lights", "4,8", "--pieces", "1,2", "--shadows", "stencil", "-o",
                                 path("f.csv"), "-o", path("f.svg")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("lights (R^2 "));
  EXPECT_THAT(outcome.out, HasSubstr("triangles (R^2 "));
  const std::string csv = read_text(folder_ / "f.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, HasSubstr("\nstencil,lights,"));
  EXPECT_THAT(csv, HasSubstr("\nstencil,triangles,"));
  EXPECT_THAT(read_text(folder_ / "f.svg"), testing::StartsWith("<svg "));
  expect_failure(bench({"-o", path("f.txt")}), 1, "f.txt");
  expect_failure(bench({"--lights", "0"}), 2, "--lights");
  expect_failure(bench({"--shadows", "guess"}), 2, "--shadows");
  expect_failure(bench({"--gl-device", "1000"}), 1, "no OpenGL device");
}

/// While it lives the environment has these variables.
class Environment {
 public:
  using Variables = std::vector<std::pair<std::string, std::string>>;
  explicit Environment(Variables variables) : variables_(std::move(variables)) {
    for (const auto& [name, value] : variables_) ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& [name, value] : variables_) ::unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  Variables variables_;
};

// Mesa hides from a program what it is told to hide; other drivers know no such variables.
TEST_F(CommandTest, GlThatLacksExtensionsDrawsTheSame) {
  const auto draw = [&](const char* name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", own("cornell_box.scene"), "-o", path(name), "--size",
                               "48x48", "--lights", "16", "--samples", "1", "--json"});
    return run(more);
  };
  ASSERT_EQ(draw("cpu.pfm", {}).code, 0);
  const Image cpu = read_image(folder_ / "cpu.pfm");
  const std::pair<std::string, std::string> es = {"MESA_GL_VERSION_OVERRIDE", "2.1"};
  const std::pair<std::string, std::string> es_3_0 = {"MESA_GLES_VERSION_OVERRIDE", "3.0"};
  const auto without = [](const std::string& extensions) {
    return std::pair<std::string, std::string>("MESA_EXTENSION_OVERRIDE", extensions);
  };
  const std::vector<Environment::Variables> lacking = {
      {},
      {{"MESA_GL_VERSION_OVERRIDE", "3.3"}, without("-GL_ARB_clip_control")},
      {es, without("-GL_EXT_depth_clamp")},
      {es, without("-GL_EXT_clip_control")},
      {es, without("-GL_EXT_disjoint_timer_query")},
      {es, es_3_0,
       without("-GL_EXT_depth_clamp -GL_EXT_clip_control -GL_EXT_disjoint_timer_query "
               "-GL_EXT_float_blend -GL_OES_texture_float_linear")}};
  for (const Environment::Variables& variables : lacking) {
    SCOPED_TRACE(testing::PrintToString(variables));
    const Environment environment(variables);
    Outcome outcome;
    for (const char* shadows : {"maps", "stencil"}) {
      outcome = draw("gl.pfm", {"--backend", "gl", "--shadows", shadows});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const Image gl = read_image(folder_ / "gl.pfm");
      // All but edges of surfaces agrees to the rounding of normals.
      int differing = 0;
      for (std::size_t i = 0; i < cpu.pixels.size(); ++i) {
        constexpr float kRounding = 1e-3f;
        const Rgb off = glm::abs(gl.pixels[i] - cpu.pixels[i]);
        differing += max_component(off) > kRounding * max_component(cpu.pixels[i]) ? 1 : 0;
      }
      EXPECT_LT(differing, 0.01 * 48 * 48) << shadows;
    }
    // Mesa may say on standard output what it could not hide.
    const auto json = [](const std::string& out) {
      return nlohmann::json::parse(out.substr(out.find('{')));
    };
    const bool timers = !json(run({"info", "--gl", "--json"}).out)["features"]["timers"].is_null();
    EXPECT_EQ(json(outcome.out).contains("seconds_gpu"), timers);
  }
}

TEST_F(CommandTest, SaysInOneLineWhatGlCannotDo) {
  const auto draw = [&](const std::string& size) {
    return run({"render", own("furnace.scene"), "-o", path("a.pfm"), "--backend", "gl", "--lights",
                "4", "--samples", "1", "--size", size});
  };
  const auto gl = nlohmann::json::parse(run({"info", "--gl", "--json"}).out);
  const int largest = gl["limits"]["texture size"];
  if (largest < 32768) {
    expect_failure(draw(std::to_string(largest + 1) + "x1"), 1, "is the most it takes");
    EXPECT_THAT(files(), testing::IsEmpty());
  }
  if (gl["version"].get<std::string>().find("Mesa") == std::string::npos) return;
  const auto fails_without = [&](const std::string& extension, const std::string& what,
                                 const std::vector<std::string>& arguments) {
    const Environment environment(
        {{"MESA_GL_VERSION_OVERRIDE", "2.1"}, {"MESA_EXTENSION_OVERRIDE", "-" + extension}});
    Outcome outcome = run(arguments);
    outcome.out.clear();  // Mesa's own words about the variable
    expect_failure(outcome, 1, what);
  };
  fails_without("GL_EXT_color_buffer_float", "float textures",
                render("a.pfm", {"--backend", "gl"}));
  fails_without("GL_EXT_float_blend", "float blending", radiosity("gpu", {}));
}

TEST_F(CommandTest, SaysWhereAShaderOfAFolderIsWrong) {
  fs::copy(fs::path(LANTERN_SOURCE_DIR) / "shaders", folder_ / "shaders");
  const std::string name = path("shaders/octahedral.glsl");
  const Environment environment({{"LANTERN_SHADERS", folder_.path().string()}});
  const auto arguments = render("a.pfm", {"--backend", "gl"});
  EXPECT_EQ(run(arguments).code, 0);
  const std::string good = read_text(name);
  const auto lines = std::count(good.begin(), good.end(), '\n');
  write_file(name, good + "float twice(float a) { return a + b; }\n");
  expect_failure(run(arguments), 1, "shaders/octahedral.glsl:" + std::to_string(lines + 1));
}

TEST_F(CommandTest, TellsWhatTheStagesOfGlTake) {
  const auto stages = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--backend", "gl", "--json"});
    const Outcome outcome = run(render("g.pfm", more));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const auto json = stages({});
  // Mesa has timers; other drivers need not.
  if (!json.contains("seconds_gpu")) GTEST_SKIP() << "no timers";
  EXPECT_THAT(keys(json["seconds_gpu"]),
              testing::UnorderedElementsAre("surfaces", "volumes", "shading", "resolve"));
  for (const auto& seconds : json["seconds_gpu"]) EXPECT_GE(seconds, 0.0);
  EXPECT_THAT(keys(stages({"--shadows", "interleaved"})["seconds_gpu"]),
              testing::Contains("filter"));
  // Maps are asked where light is added.
  EXPECT_THAT(keys(stages({"--shadows", "maps"})["seconds_gpu"]),
              testing::UnorderedElementsAre("surfaces", "maps", "resolve"));
  // Rays have no stages of a GPU.
  const Outcome cpu = run(render("c.pfm", {"--json"}));
  EXPECT_FALSE(nlohmann::json::parse(cpu.out).contains("seconds_gpu"));
}
#endif

TEST_F(CommandTest, InfoTellsWhatIsThere) {
  const Outcome outcome = run({"info", own("cornell_box.scene"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(keys(json), IsSupersetOf({"triangles", "materials", "emitters", "bounds", "cameras",
                                        "mean_reflectivity", "warnings"}));
  ASSERT_EQ(json["emitters"].size(), 1u);
  // The lamp of 1.30 m x 1.05 m: flux is radiance times area times pi.
  EXPECT_NEAR(json["emitters"][0]["area"], 1.365, 1e-4);
  EXPECT_NEAR(json["emitters"][0]["flux"][0], 17.0 * 1.365 * 3.14159265, 0.01);
  const Outcome text = run({"info", own("cornell_box.scene")});
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.out, HasSubstr("cornell/light"));
}

TEST_F(CommandTest, WritesLightsInThreeFormats) {
  for (const char* name : {"l.json", "l.ply", "l.gltf"}) {
    const Outcome outcome =
        run({"lights", own("furnace.scene"), "-o", path(name), "--lights", "60"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const auto json = nlohmann::json::parse(read_text(folder_ / "l.json"));
  EXPECT_THAT(keys(json), testing::UnorderedElementsAre("paths", "reflectivity", "lights"));
  EXPECT_EQ(json["paths"], 60);
  EXPECT_THAT(keys(json["lights"][0]),
              IsSupersetOf({"position", "normal", "flux", "path", "bounce"}));
  EXPECT_THAT(read_text(folder_ / "l.ply"), testing::StartsWith("ply\n"));
  const auto gltf = nlohmann::json::parse(read_text(folder_ / "l.gltf"));
  EXPECT_EQ(gltf["extensions"]["KHR_lights_punctual"]["lights"].size(), json["lights"].size());
  expect_failure(run({"lights", own("furnace.scene"), "-o", path("l.txt")}), 2, "l.txt");
}

TEST_F(CommandTest, RendersTheSameFromAFileOfLights) {
  for (const char* scene : {"cornell_box.scene", "furnace.scene"}) {
    ASSERT_EQ(run({"lights", own(scene), "-o", path("l.json"), "--lights", "16"}).code, 0);
    ASSERT_EQ(run(render("walked.exr", {"--depth", "float"}, scene)).code, 0);
    const std::vector<std::string> from_file = {"--depth", "float", "--lights-from",
                                                path("l.json")};
    ASSERT_EQ(run(render("read.exr", from_file, scene)).code, 0);
    EXPECT_EQ(read_image(folder_ / "read.exr").pixels, read_image(folder_ / "walked.exr").pixels);
  }
}

TEST_F(CommandTest, RefusesWrongUsage) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"paint"},
      {"render"},
      {"render", own("furnace.scene")},
      {"view", own("furnace.scene")},
      {"compare", path("a.pfm")},
      render("a.png", {"--no-such-option"}),
      render("a.png", {"--method", "path"}),  // with --lights
      {"render", own("furnace.scene"), "-o", path("a.png"), "--method", "path", "--compensate"},
      {"render", own("furnace.scene"), "-o", path("a.png"), "--method", "path", "--variance",
       path("v.png")},
      {"render", own("furnace.scene"), "-o", path("a.exr"), "--method", "path", "--variance",
       path("a.exr")},
      render("a.png", {"--variance", path("v.exr")}),
      render("a.png", {"--method", "radiosity-matrix"}),  // --lights
      radiosity("matrix", {"--hemicube", "32"}),
      radiosity("matrix", {"--solver", "guess"}),
      radiosity("matrix", {"--patch-size", "0"}),
      radiosity("matrix", {"--time", "1"}),
      radiosity("hemicube", {"--solver", "elimination"}),
      render("a.png", {"--method", "guess"}),
      render("a.png", {"--backend", "gl", "--compensate"}),
      render("a.png", {"--backend", "gl", "--tile", "4"}),
      render("a.png", {"--backend", "gl", "--shadows", "interleaved", "--tile", "3"}),
      render("a.png", {"--shadows", "stencil"}),
      render("a.png", {"--deal-lights"}),
      render("a.png", {"--show-volumes", "0"}),
      render("a.png", {"--backend", "gl", "--show-volumes", "first"}),
      render("a.png", {"--backend", "gl", "--volumes", "z"}),
      {"render", own("furnace.scene"), "-o", path("a.png"), "--method", "path", "--backend", "gl"},
      render("a.png", {"--size", "12"}),
      render("a.png", {"--size", "0x4"}),
      render("a.png", {"--lights", "0"}),
      render("a.png", {"--lights", "many"}),
      render("a.png", {"--reflectivity", "1.5"}),
      render("a.gif"),
      render("a.png", {"--look-at", "1,2,3"}),
      render("a.png", {"--look-at", "0,0,0,0,1,0"}),
      render("a.png", {"--sky", "1,2"}),
      render("a.png", {"--sky", "1,2,-3"}),
      render("a.png", {"--fov", "180"}),
      render("a.png", {"--emitter", "lamp"}),
      render("a.png", {"--time", "-1"}),
      render("a.png", {"--patches", "100"}),
      render("a.png", {"--method", "radiosity-progressive"}),  // --lights
      radiosity("hemicube", {"--cutoff", "0.1"}),
      radiosity("hemicube", {"--passes", "2"}),
      radiosity("progressive", {"--patches", "0"}),
      radiosity("progressive", {"--patch-size", "0"}),
      radiosity("progressive", {"--patch-size", "1", "--patches", "10"}),
      radiosity("progressive", {"--hemicube", "12"}),
      radiosity("progressive", {"--cutoff", "2"}),
      render("a.png", {"--threads", "-2"}),
  };
  for (const auto& arguments : wrong) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(run(arguments), 2, "--help");
  }
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(CommandTest, FailsInOneLine) {
  expect_failure(run({"render", path("none.mesh"), "-o", path("a.png")}), 1, "none.mesh");
  expect_failure(run({"info", path("none.glb")}), 1, "none.glb");
  expect_failure(run({"compare", path("none.exr"), path("none.exr")}), 1, "none.exr");
  expect_failure(run(render("a.png", {"--camera", "nobody"})), 1, "nobody");
  expect_failure(run(render("a.png", {"--emitter", "nothing*=1,1,1"})), 1, "nothing*");
  expect_failure(run(render("a.png", {"--sky", path("none.hdr")})), 1, "none.hdr");
  expect_failure(run(render("a.png", {"--lights-from", path("none.json")})), 1, "none.json");
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(CommandTest, SaysHowToLightASceneWithoutLight) {
  write_file(folder_ / "dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_failure(run({"render", path("dark.obj"), "-o", path("a.png")}), 1, "--emitter");
  expect_failure(run({"lights", path("dark.obj"), "-o", path("l.json")}), 1, "--emitter");
  EXPECT_THAT(files(), testing::ElementsAre("dark.obj"));
}

TEST_F(CommandTest, LeavesNoFileWhereItCannotWrite) {
  expect_failure(run(render("no/such/folder/a.png")), 1, "no/such/folder/a.png");
  fs::create_directory(folder_ / "folder.png");
  expect_failure(run(render("folder.png")), 1, "folder.png");
  fs::remove(folder_ / "folder.png");
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(CommandTest, OverwritesNothingThatItReads) {
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  write_file(folder_ / "a.png", mesh);
  for (const char* command : {"render", "lights"}) {
    expect_failure(run({command, path("a.png"), "-o", path("a.png")}), 2, "a.png");
  }
  EXPECT_EQ(read_text(folder_ / "a.png"), mesh);
}

TEST_F(CommandTest, FailsOnAFileThatGrowsTooLarge) {
  const Outcome outcome = [&] {
    // Room for what it says, not for the picture.
    const LimitScope limit(RLIMIT_FSIZE, 512);
    return run(render("a.pfm"));
  }();
  expect_failure(outcome, 1, "a.pfm");
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(CommandTest, FailsOnAFullDevice) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"}) {
    fs::create_symlink("/dev/full", folder_ / name);
    expect_failure(run(render(name)), 1, name);
  }
  for (const char* name : {"l.json", "l.ply", "l.gltf"}) {
    fs::create_symlink("/dev/full", folder_ / name);
    expect_failure(run({"lights", own("furnace.scene"), "-o", path(name)}), 1, name);
  }
  EXPECT_EQ(files().size(), 7u);
  expect_failure(run(render("/dev/full")), 1, "/dev/full");
}

TEST_F(CommandTest, KeepsTheOldPictureUntilTheNewOneIsWhole) {
  write_file(folder_ / "a.png", "old");
  expect_failure(run(render("a.png", {"--camera", "nobody"})), 1);
  EXPECT_EQ(read_text(folder_ / "a.png"), "old");
  const Running running = start(render("a.png", {"--passes", "1000000", "--quiet"}));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(running.process, SIGKILL);
  EXPECT_EQ(finish(running).code, 128 + SIGKILL);
  EXPECT_EQ(read_text(folder_ / "a.png"), "old");
  EXPECT_THAT(files(), testing::ElementsAre("a.png"));
}

TEST_F(CommandTest, WritesWhatIsThereWhenInterrupted) {
  // One endless pass, and passes without end.
  const std::vector<std::vector<std::string>> endless = {
      {"--size", "2048x2048", "--lights", "4000"},
      {"--size", "64x64", "--passes", "100000000"},
      {"--size", "1024x1024", "--samples", "10000", "--method", "path"},
      {"--size", "64x64", "--passes", "100000000", "--method", "path"}};
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const auto& options : endless) {
      std::vector<std::string> arguments = {"render", own("cornell_box.scene"), "-o",
                                            path("a.exr")};
      arguments.insert(arguments.end(), options.begin(), options.end());
      const Running running = start(arguments);
      std::this_thread::sleep_for(std::chrono::seconds(1));
      ::kill(running.process, signal);
      const Outcome outcome = finish(running);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_LT(outcome.seconds, 1.0 + kPatience);
      EXPECT_THAT(outcome.err, HasSubstr("stopped early"));
      EXPECT_GT(read_image(folder_ / "a.exr").width, 0);
      fs::remove(folder_ / "a.exr");
    }
  }
}

TEST_F(CommandTest, KeepsToItsTime) {
  const Outcome outcome = run({"render", own("cornell_box.scene"), "-o", path("a.exr"), "--time",
                               "1", "--size", "128x128", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(outcome.seconds, 1.0 + kPatience);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["passes"], 0);
}

/// Every loader's files: the whole one loads, no part of it and no garbage does worse than fail.
TEST_F(CommandTest, FailsInOneLineOnBrokenScenes) {
  const fs::path seeds = fs::path(LANTERN_SOURCE_DIR) / "fuzz/seeds";
  const std::vector<std::pair<fs::path, std::string>> whole = {
      {seeds / "ogre_binary/list.mesh", "a.mesh"}, {seeds / "ogre_xml/list.xml", "a.mesh.xml"},
      {seeds / "ogre_scene/all.scene", "a.scene"}, {seeds / "assimp/all.gltf", "a.gltf"},
      {seeds / "assimp/all.glb", "a.glb"},         {own("furnace.mesh.xml"), "b.mesh.xml"}};
  for (const auto& [source, name] : whole) {
    SCOPED_TRACE(source.string());
    const std::string bytes = read_text(source);
    const auto render_bytes = [&](const std::string& content) {
      std::ofstream(folder_ / name, std::ios::binary) << content;
      return run({"render", path(name), "-o", path("out.png"), "--size", "4x4", "--sky", "1,1,1",
                  "--quiet"});
    };
    for (const std::size_t share : {1, 3, 5, 7}) {
      const Outcome outcome = render_bytes(bytes.substr(0, bytes.size() * share / 8));
      expect_failure(outcome, 1, name);
      EXPECT_FALSE(fs::exists(folder_ / "out.png"));
    }
    expect_failure(render_bytes(""), 1, name);
    expect_failure(render_bytes(std::string(500, '\xa5')), 1, name);
    expect_failure(render_bytes(std::string(500, '\0')), 1, name);
    EXPECT_FALSE(fs::exists(folder_ / "out.png"));
  }
}

TEST_F(CommandTest, FailsInOneLineOnBrokenLights) {
  for (const char* text : {"", "[]", "{", "{\"paths\": 1}", "{\"paths\": -1, \"lights\": 3}"}) {
    SCOPED_TRACE(text);
    write_file(folder_ / "l.json", text);
    expect_failure(run(render("a.png", {"--lights-from", path("l.json")})), 1, "l.json");
  }
}

TEST_F(CommandTest, SaysInOneLineThatNoOpenGlIsThere) {
  // No vendor's driver, a library that is none, and only versions that are too old.
  write_file(folder_ / "libEGL.so.1", std::string_view("no library"));
  const std::string folder = folder_.path().string();
  using Variables = std::vector<std::pair<const char*, const char*>>;
  for (const Variables& variables :
       {Variables{{"__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null"}},
        Variables{{"LD_LIBRARY_PATH", folder.c_str()}},
        Variables{{"MESA_GL_VERSION_OVERRIDE", "2.1"}, {"MESA_GLES_VERSION_OVERRIDE", "2.0"}}}) {
    for (const auto& [name, value] : variables) ::setenv(name, value, 1);
    expect_failure(run({"info", "--gl"}), 1, "no usable OpenGL: ");
    expect_failure(run(radiosity("gpu", {})), 1, "no usable OpenGL: ");
    for (const auto& [name, value] : variables) ::unsetenv(name);
  }
}

TEST_F(CommandTest, HelpsAndTellsItsVersion) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--help"},
                                                                     {"--version"},
                                                                     {"render", "--help"},
                                                                     {"lights", "--help"},
                                                                     {"info", "--help"},
                                                                     {"compare", "--help"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace lantern
