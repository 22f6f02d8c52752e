// SPDX-License-Identifier: MIT
#include "lantern/pipeline/convergence.h"

#include "lantern/core/error.h"
#include "lantern/load/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

namespace lantern {
namespace {

constexpr int kSize = 16;

Scene furnace() {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/furnace.scene").scene;
}

ConvergenceRun lights_run(std::size_t paths) {
  ConvergenceRun run;
  run.method = "instant-radiosity";
  run.effort = Effort::kLights;
  run.asked = static_cast<double>(paths);
  run.options.lights.paths = paths;
  return run;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

TEST(Convergence, ARenderIsItsOwnReference) {
  const Scene scene = furnace();
  const StopFlag stop{false};
  ConvergenceRun run = lights_run(32);
  RenderOptions options = run.options;
  options.width = options.height = kSize;
  const Image reference = render(scene, options, stop).image;
  const ConvergencePoint same = measure(scene, run, reference, {}, stop);
  EXPECT_EQ(same.error.relmse, 0.0);
  EXPECT_EQ(same.flip, 0.0);
  EXPECT_GT(same.seconds, 0.0);
  EXPECT_GT(same.statistics.lights, 32u);
  EXPECT_EQ(same.run.asked, 32.0);
}

// The furnace: an enclosed surface of reflectance a that emits E everywhere shows E/(1-a), see its
// file. Lights by the thousand are nearer to that than lights by the dozen.
TEST(Convergence, MoreLightsLessError) {
  const Scene scene = furnace();
  const StopFlag stop{false};
  const Material& wall = scene.materials.at(0);
  const Image reference(kSize, kSize, wall.emission / (Rgb(1.0f) - wall.reflectance));
  double before = 1e9;
  for (const std::size_t paths : {16, 256, 4096}) {
    const double now = measure(scene, lights_run(paths), reference, {}, stop).error.relmse;
    EXPECT_LT(now, before) << paths;
    before = now;
  }
}

TEST(Convergence, WritesATable) {
  ConvergencePoint point;
  point.run = lights_run(64);
  point.seconds = 1.5;
  point.statistics.lights = 120;
  point.error.relmse = 0.25;
  const std::vector<std::string> lines = split(to_csv(std::vector{point, point}), '\n');
  ASSERT_EQ(lines.size(), 3u);
  const std::vector<std::string> names = split(lines[0], ','), values = split(lines[1], ',');
  ASSERT_EQ(names.size(), values.size());
  const auto value = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? "missing" : values[static_cast<std::size_t>(at - names.begin())];
  };
  EXPECT_EQ(value("method"), "instant-radiosity");
  EXPECT_EQ(value("effort"), "lights");
  EXPECT_EQ(value("asked"), "64");
  EXPECT_EQ(value("seconds"), "1.5000");
  EXPECT_EQ(value("lights"), "120");
  EXPECT_EQ(value("relmse"), "0.25");
}

TEST(Convergence, PlotsOnlyWhatWasMeasured) {
  using testing::HasSubstr;
  using testing::Not;
  ConvergencePoint lights;
  lights.run = lights_run(64);
  lights.statistics.lights = 120;
  lights.error.relmse = 0.25;
  ConvergencePoint time = lights;
  time.run.effort = Effort::kSeconds;
  time.run.method = "path";
  time.seconds = 2.0;
  const std::string one = to_svg(std::vector{lights}, "box");
  EXPECT_THAT(one, HasSubstr("instant-radiosity"));
  EXPECT_THAT(one, Not(HasSubstr("over time")));
  const std::string both = to_svg(std::vector{lights, time}, "box");
  EXPECT_THAT(both, HasSubstr("box: error over time"));
  EXPECT_THAT(both, HasSubstr("box: error over the lights"));
  EXPECT_THAT(both, HasSubstr(">path<"));
}

}  // namespace
}  // namespace lantern
