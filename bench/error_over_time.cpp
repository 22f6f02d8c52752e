// SPDX-License-Identifier: MIT
// Error over time against a reference picture, as a table: each row is a render of its own, loading
// and all, stopped after so many seconds.
//   error_over_time SCENE REFERENCE [--seconds 1,2.5,5,10] [render options]
#include "lantern/image/compare.h"
#include "lantern/image/read.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/edits.h"
#include "lantern/pipeline/render.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <chrono>
#include <sys/resource.h>

namespace {

using namespace lantern;

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double percent_off(double a, double b) { return 100.0 * (a / b - 1.0); }

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Error over time against a reference");
  std::string scene_path, reference_path, seconds = "1,2.5,5,10", look_at;
  RenderOptions options;
  options.lights.paths = 32;
  options.lights.pool = 16;
  options.passes = 0;
  options.bound = 5.0f;
  options.compensate = true;
  float fov = 0.0f;
  app.add_option("scene", scene_path)->required();
  app.add_option("reference", reference_path)->required();
  app.add_option("--seconds", seconds, "Times, separated by commas")->capture_default_str();
  app.add_option("--lights", options.lights.paths)->capture_default_str();
  app.add_option("--pool", options.lights.pool)->capture_default_str();
  app.add_option("--bound", options.bound)->capture_default_str();
  app.add_flag("--compensate,!--no-compensate", options.compensate)->capture_default_str();
  app.add_option("--look-at", look_at);
  app.add_option("--fov", fov);
  CLI11_PARSE(app, argc, argv);
  try {
    const Image reference = read_image(reference_path);
    options.width = reference.width;
    options.height = reference.height;
    if (fov > 0.0f) options.camera.vertical_fov = glm::radians(fov);
    if (!look_at.empty()) {
      const std::vector<float> v = parse_numbers(look_at);
      options.camera.eye = Vec3(v.at(0), v.at(1), v.at(2));
      options.camera.target = Vec3(v.at(3), v.at(4), v.at(5));
    }
    const StopFlag stop{false};
    fmt::print("{:>8}{:>12}{:>8}{:>14}{:>12}   {}\n", "seconds", "processor/2", "passes",
               "M shadow rays", "relmse", "mean off by, RGB");
    for (const float limit : parse_numbers(seconds)) {
      const double processor_before = processor_seconds();
      const auto start = std::chrono::steady_clock::now();
      const Loaded loaded = load_scene(scene_path);
      options.seconds = static_cast<double>(limit);
      const Rendered rendered = render(loaded.scene, options, stop);
      const double took =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const double processor = processor_seconds() - processor_before;
      const Comparison c = compare(rendered.image, reference);
      fmt::print("{:>8.2f}{:>12.2f}{:>8}{:>14.0f}{:>12.3g}   {:+.2f} % {:+.2f} % {:+.2f} %\n", took,
                 processor / 2.0, rendered.statistics.passes,
                 static_cast<double>(rendered.statistics.rays.shadow_rays) * 1e-6, c.relmse,
                 percent_off(c.mean_a.r, c.mean_b.r), percent_off(c.mean_a.g, c.mean_b.g),
                 percent_off(c.mean_a.b, c.mean_b.b));
      std::fflush(stdout);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "error_over_time: {}\n", e.what());
    return 1;
  }
}
