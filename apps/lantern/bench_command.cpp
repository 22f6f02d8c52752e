// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/read.h"
#include "lantern/pipeline/convergence.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/methods.h"
#include "apps/lantern/options.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace lantern::app {
namespace {

struct Arguments {
  SceneArguments scene;
  CameraArguments camera;
  std::string reference;
  double reference_seconds = 0.0;  // 0: not given
  std::string size = "256x256";
  std::vector<std::string> methods;
  std::vector<double> seconds, lights;
  std::size_t pool = 16;
  float bound = 5.0f;
  bool compensate = true;
  float exposure = 0.0f;
  std::vector<std::string> outputs;
};

RenderOptions render_options(const Arguments& arguments, const std::string& method) {
  RenderOptions options;
  options.method = method_of(method);
  options.camera = arguments.camera.choice();
  options.bound = arguments.bound;
  options.compensate = arguments.compensate;
  return options;
}

/// Samples of a pixel in a pass of small ones, or in the one picture of a solution.
int samples_in_time(Method method) {
  switch (method) {
    case Method::kInstantRadiosity:
      return 1;
    case Method::kPath:
      return kPathSamplesInTime;
    default:
      return 16;
  }
}

/// Small passes, as many as the time allows.
ConvergenceRun in_time(const Arguments& arguments, const std::string& method, double seconds) {
  ConvergenceRun run{method, Effort::kSeconds, seconds, render_options(arguments, method)};
  constexpr std::size_t kPathsOfPass = 32;
  run.options.passes = 0;
  run.options.samples = samples_in_time(run.options.method);
  run.options.seconds = seconds;
  run.options.lights.paths = kPathsOfPass;
  run.options.lights.pool = arguments.pool;
  return run;
}

/// One pass, which must smooth its edges by itself.
ConvergenceRun with_lights(const Arguments& arguments, const std::string& method, double paths) {
  ConvergenceRun run{method, Effort::kLights, paths, render_options(arguments, method)};
  run.options.samples = 4;
  run.options.lights.paths = static_cast<std::size_t>(paths);
  return run;
}

bool has_lights(Method method) { return method == Method::kInstantRadiosity; }

void check(Arguments& arguments) {
  arguments.scene.check();
  parse_size(arguments.size);
  if (arguments.methods.empty()) arguments.methods = available_methods();
  for (const std::string& method : arguments.methods) method_of(method);
  if (arguments.seconds.empty() && arguments.lights.empty()) {
    arguments.seconds = {1.0, 2.0, 4.0, 8.0};
    arguments.lights = {16.0, 64.0, 256.0, 1024.0};
  }
  std::sort(arguments.seconds.begin(), arguments.seconds.end());
  for (const std::string& out : arguments.outputs) {
    if (extension(out) != ".csv" && extension(out) != ".svg") {
      throw Error(out + ": only .csv and .svg are written");
    }
    require_writable(out);
  }
}

/// Read, or made by the judge with a seed that no measured render has.
Image make_reference(const Arguments& arguments, const Scene& scene, const StopFlag& stop) {
  if (!arguments.reference.empty()) return read_image(arguments.reference);
  constexpr std::uint64_t kOwnSeed = 0x5eed;
  RenderOptions options = in_time(arguments, "path", arguments.reference_seconds).options;
  std::tie(options.width, options.height) = parse_size(arguments.size);
  options.path.seed = kOwnSeed;
  ProgressBar bar(arguments.scene.quiet);
  return render(scene, options, stop, [&](const Progress& p) { bar.show(p); }).image;
}

void print_head() {
  fmt::print("{:<22}{:>14}{:>9}{:>11}{:>8}{:>9}{:>11}{:>9}\n", "method", "asked", "seconds",
             "processor", "passes", "lights", "relmse", "flip");
}

void print_row(const ConvergencePoint& point) {
  const bool timed = point.run.effort == Effort::kSeconds;
  fmt::print("{:<22}{:>14}{:>9.2f}{:>11.2f}{:>8}{:>9}{:>11.3g}{:>9.4f}\n", point.run.method,
             fmt::format("{:g} {}", point.run.asked, timed ? "s" : "paths"), point.seconds,
             point.processor_seconds, point.statistics.passes, point.statistics.lights,
             point.error.relmse, point.flip);
  std::fflush(stdout);
}

std::vector<ConvergencePoint> measure_all(const Arguments& arguments, const Scene& scene,
                                          const Image& reference, const StopFlag& stop) {
  FlipOptions flip_with;
  flip_with.tone.exposure = arguments.exposure;
  std::vector<ConvergencePoint> points;
  const auto add = [&](const ConvergenceRun& run) {
    ConvergencePoint point = measure(scene, run, reference, flip_with, stop);
    if (stop.load()) return;  // it was cut short
    print_row(point);
    points.push_back(std::move(point));
  };
  for (const std::string& method : arguments.methods) {
    double needed = 0.0;  // a method that needs more than it is asked for is not asked again
    for (const double seconds : arguments.seconds) {
      if (stop.load() || seconds <= needed) continue;
      add(in_time(arguments, method, seconds));
      if (!points.empty()) needed = points.back().seconds;
    }
  }
  for (const std::string& method : arguments.methods) {
    if (!has_lights(method_of(method))) continue;
    for (const double paths : arguments.lights) {
      if (!stop.load()) add(with_lights(arguments, method, paths));
    }
  }
  return points;
}

void run_convergence(Arguments& arguments) {
  check(arguments);
  ThreadScope threads(arguments.scene.threads);
  threads.run([&] {
    const StopFlag& stop = stop_on_interrupt();
    const Loaded loaded = arguments.scene.load_scene_now();
    const Image reference = make_reference(arguments, loaded.scene, stop);
    print_head();
    const std::vector<ConvergencePoint> points =
        measure_all(arguments, loaded.scene, reference, stop);
    const std::string name = arguments.scene.path.stem().string();
    for (const std::string& out : arguments.outputs) {
      write_file(out, extension(out) == ".csv" ? to_csv(points) : to_svg(points, name));
    }
    if (stop.load()) warn("stopped early; what was measured until then is there");
  });
}

void add_convergence(CLI::App& bench) {
  auto arguments = std::make_shared<Arguments>();
  Arguments& a = *arguments;
  CLI::App* command = bench.add_subcommand(
      "convergence", "Error over time and over lights against a reference picture");
  a.scene.add_to(*command);
  a.camera.add_to(*command);
  CLI::Option_group* reference = command->add_option_group("reference");
  CLI::Option* file =
      reference->add_option("--reference", a.reference, "The picture to compare with");
  reference
      ->add_option("--reference-seconds", a.reference_seconds,
                   "Make it by path tracing for so many seconds")
      ->check(finite(1e-3, 1e9));
  reference->require_option(1);
  command->add_option("--size", a.size, "WxH of a reference that is made")
      ->capture_default_str()
      ->excludes(file);
  const auto add_list = [&](const char* name, auto& values, const char* what) {
    return command->add_option(name, values, what)->delimiter(',')->allow_extra_args(false);
  };
  add_list("--methods", a.methods, "Methods, separated by commas (all there are)");
  add_list("--seconds", a.seconds, "Times to give each method, separated by commas (1,2,4,8)")
      ->check(finite(1e-3, 1e9));
  add_list("--lights", a.lights,
           "Light paths of a single pass, separated by commas (16,64,256,1024)")
      ->check(finite(1.0, 1e8));
  command
      ->add_option("--pool", a.pool,
                   "Instant radiosity in time: walk so many times the paths, keep what matters")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000}))
      ->capture_default_str();
  command->add_option("--bound", a.bound, "Bound of instant radiosity, as in render")
      ->check(finite(0.0, 1e30))
      ->capture_default_str();
  command
      ->add_flag("--compensate,!--no-compensate", a.compensate,
                 "Give back what the bound takes, or do not")
      ->capture_default_str();
  command->add_option("--exposure", a.exposure, "Stops, for FLIP")
      ->check(finite(-100.0, 100.0))
      ->capture_default_str();
  command->add_option("-o,--output", a.outputs, "OUT.csv (a table), OUT.svg (a plot); repeatable")
      ->allow_extra_args(false);
  command->callback([arguments] { run_convergence(*arguments); });
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* bench = app.add_subcommand("bench", "Measure methods against each other");
  bench->require_subcommand(1);
  add_convergence(*bench);
  add_bench_frames(*bench);
}

}  // namespace lantern::app
