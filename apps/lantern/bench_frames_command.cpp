// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/pipeline/frames.h"
#include "lantern/pipeline/render_instant_radiosity.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/options.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace lantern::app {
namespace {

struct Arguments {
  SceneArguments scene;
  CameraArguments camera;
  std::string size = "640x480";
  std::vector<std::string> shadows = {"stencil", "interleaved", "maps"};
  int tile = 4;
  int gl_device = -1;
  std::vector<std::size_t> lights = {8, 16, 32, 64, 128, 256};
  std::vector<std::uint32_t> pieces = {1, 2, 4, 8, 16};
  double seconds = 1.0;
  std::vector<std::string> outputs;
};

/// Triangles are varied under as many lights as so many paths leave: about 64.
constexpr std::size_t kPathsOverTriangles = 32;

FrameRun frame_run(const Arguments& arguments, const std::string& shadows, FrameCost cost) {
  FrameRun run{.shadows = shadows, .cost = cost, .pieces = 1, .options = {}};
  std::tie(run.options.width, run.options.height) = parse_size(arguments.size);
  run.options.camera = arguments.camera.choice();
  run.options.backend = Backend::kGl;
  if (shadows == "interleaved") {
    run.options.tile = arguments.tile;
    run.options.shadows = ShadowMethod::kCheaper;
  }
  if (shadows == "maps") run.options.shadows = ShadowMethod::kMaps;
  if (arguments.gl_device >= 0) run.options.gl_device = arguments.gl_device;
  return run;
}

void check(Arguments& arguments) {
  arguments.scene.check();
  parse_size(arguments.size);
  arguments.camera.choice();
  for (const std::string& out : arguments.outputs) {
    if (extension(out) != ".csv" && extension(out) != ".svg") {
      throw Error(out + ": only .csv and .svg are written");
    }
    require_writable(out);
  }
}

void print_head() {
  fmt::print("{:<14}{:>8}{:>11}{:>10}{:>11}{:>15}{:>9}\n", "shadows", "lights", "triangles",
             "frames/s", "ms a frame", "ms processor", "ms GPU");
}

void print_row(const FramePoint& p) {
  const auto milliseconds = [](double seconds) { return fmt::format("{:.2f}", 1e3 * seconds); };
  fmt::print("{:<14}{:>8}{:>11}{:>10.2f}{:>11}{:>15}{:>9}\n", p.run.shadows, p.lights, p.triangles,
             1.0 / p.seconds, milliseconds(p.seconds), milliseconds(p.processor_seconds),
             p.gpu_seconds ? milliseconds(*p.gpu_seconds) : "-");
  std::fflush(stdout);
}

/// The line through one kind of frames, in each of the measures.
void print_fit(std::span<const FramePoint> points, const std::string& shadows, FrameCost cost) {
  const auto print = [&](const char* measure, const std::function<double(const FramePoint&)>& y) {
    std::vector<glm::dvec2> measured;
    for (const FramePoint& p : points) {
      if (p.run.shadows == shadows && p.run.cost == cost) measured.emplace_back(p.varied(), y(p));
    }
    const std::optional<Line> line = fit_line(measured);
    if (!line) return;
    fmt::print("{}, ms {}: {:.4g} {} {:.4g} {} (R^2 {:.4f})\n", shadows, measure, 1e3 * line->at_0,
               line->slope < 0.0 ? '-' : '+', 1e3 * std::abs(line->slope),
               cost == FrameCost::kLights ? "lights" : "triangles", line->r_squared);
  };
  print("a frame", [](const FramePoint& p) { return p.seconds; });
  print("processor", [](const FramePoint& p) { return p.processor_seconds; });
  if (std::all_of(points.begin(), points.end(), [](const auto& p) { return p.gpu_seconds; })) {
    print("GPU", [](const FramePoint& p) { return *p.gpu_seconds; });
  }
}

std::vector<FramePoint> measure_all(const Arguments& arguments, const Scene& scene,
                                    const StopFlag& stop) {
  std::vector<FramePoint> points;
  const auto add = [&](const FrameRun& run, std::size_t paths) {
    if (stop.load()) return;
    LightOptions light_options;
    light_options.paths = paths;
    std::vector<std::string> warnings;  // of the walk, which is not what is measured
    const VirtualLights lights = make_lights(scene, light_options, warnings);
    FramePoint point = measure_frames(scene, run, lights, arguments.seconds, stop);
    if (stop.load()) return;  // it was cut short
    if (points.empty()) print_head();
    print_row(point);
    points.push_back(std::move(point));
  };
  for (const std::string& shadows : arguments.shadows) {
    for (const std::size_t paths : arguments.lights) {
      add(frame_run(arguments, shadows, FrameCost::kLights), paths);
    }
  }
  for (const std::string& shadows : arguments.shadows) {
    for (const std::uint32_t pieces : arguments.pieces) {
      FrameRun run = frame_run(arguments, shadows, FrameCost::kTriangles);
      run.pieces = pieces;
      add(run, kPathsOverTriangles);
    }
  }
  return points;
}

void run(Arguments& arguments) {
  check(arguments);
  ThreadScope threads(arguments.scene.threads);
  threads.run([&] {
    const StopFlag& stop = stop_on_interrupt();
    const Loaded loaded = arguments.scene.load_scene_now();
    const std::vector<FramePoint> points = measure_all(arguments, loaded.scene, stop);
    for (const FrameCost cost : {FrameCost::kLights, FrameCost::kTriangles}) {
      for (const std::string& shadows : arguments.shadows) print_fit(points, shadows, cost);
    }
    const std::string name = arguments.scene.path.stem().string();
    for (const std::string& out : arguments.outputs) {
      write_file(out, extension(out) == ".csv" ? to_csv(points) : to_svg(points, name));
    }
    if (stop.load()) warn("stopped early; what was measured until then is there");
  });
}

}  // namespace

void add_bench_frames(CLI::App& bench) {
  auto arguments = std::make_shared<Arguments>();
  Arguments& a = *arguments;
  CLI::App* command = bench.add_subcommand(
      "frames", "Frames per second by OpenGL over the lights and over the triangles");
  a.scene.add_to(*command);
  a.camera.add_to(*command);
  command->add_option("--size", a.size, "WxH in pixels")->capture_default_str();
  const auto add_list = [&](const char* name, auto& values, const char* what) {
    return command->add_option(name, values, what)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
  };
  add_list("--shadows", a.shadows, "As in render, separated by commas")
      ->check(CLI::IsMember({"stencil", "interleaved", "maps"}));
  command->add_option("--tile", a.tile, "Of interleaved, as in render")
      ->check(CLI::IsMember({2, 4, 8}))
      ->capture_default_str();
  command->add_option("--gl-device", a.gl_device, "A device of `lantern info --gl`, by its number")
      ->check(CLI::Range(0, 1'000'000));
  add_list("--lights", a.lights, "Light paths to measure with, separated by commas")
      ->check(CLI::Range(1, 100'000'000));
  add_list("--pieces", a.pieces, "Each triangle is cut into PxP, the picture staying as it is")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seconds", a.seconds, "Time for each row, of which the best frame counts")
      ->check(finite(1e-3, 1e9))
      ->capture_default_str();
  command->add_option("-o,--output", a.outputs, "OUT.csv (a table), OUT.svg (a plot); repeatable")
      ->allow_extra_args(false);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
