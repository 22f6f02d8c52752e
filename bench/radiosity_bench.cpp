// SPDX-License-Identifier: MIT
// How fast hemicubes are drawn and shot: rows from centres, then progressive radiosity over time.
//   radiosity_bench SCENE [--patches N] [--hemicube N] [--cutoff C] [--time S] [--threads T]
#include "lantern/core/parallel.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/stopwatch.h"
#include "lantern/radiosity/progressive.h"
#include "lantern/trace/embree.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

namespace {

using namespace lantern;

void measure(const Scene& scene, std::size_t count, const ProgressiveOptions& options,
             double most_seconds) {
  const Stopwatch preparing;
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Patches patches = make_patches(scene, world, *tracer, {.count = count});
  fmt::print("{} patches, {} elements, hemicubes of {} pixels, made ready in {:.2f} s\n",
             patches.size(), patches.elements(), options.hemicube.resolution, preparing.seconds());
  {
    HemicubeRows rows(world, *tracer, patches, options.hemicube);
    std::vector<FormFactorRow> some(std::min<std::size_t>(256, patches.elements()));
    const std::size_t first = (patches.elements() - some.size()) / 2;
    const Stopwatch watch;
    rows.from_centres(first, some);
    const double rate = static_cast<double>(some.size()) / watch.seconds();
    fmt::print("rows from centres: {:.0f} a second, {:.1f} M pixels a second\n", rate,
               rate * static_cast<double>(rows.cubes().front().size()) * 1e-6);
  }
  ProgressiveRadiosity solution(world, *tracer, patches, options);
  fmt::print("{:>10}{:>10}{:>12}{:>10}{:>10}{:>12}\n", "seconds", "shots", "hemicubes", "shots/s",
             "unshot", "balance");
  const Stopwatch watch;
  double next = 0.5, before = 0.0;
  std::size_t shots_before = 0;
  const auto show = [&] {
    const double now = watch.seconds();
    fmt::print("{:>10.2f}{:>10}{:>12}{:>10.0f}{:>10.4f}{:>12.1e}\n", now, solution.shots(),
               solution.hemicubes(),
               static_cast<double>(solution.shots() - shots_before) / (now - before),
               solution.unshot_share(), solution.balance().error());
    before = now;
    shots_before = solution.shots();
  };
  while (watch.seconds() < most_seconds && solution.shoot()) {
    if (solution.unshot_share() > next) continue;
    show();
    next *= 0.5;
  }
  show();
  fmt::print("{:.0f} shots a second in all\n",
             static_cast<double>(solution.shots()) / watch.seconds());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Progressive radiosity over time");
  std::string path;
  std::size_t patches = 100'000;
  ProgressiveOptions options;
  double seconds = 30.0;
  int threads = 0;
  app.add_option("scene", path)->required();
  app.add_option("--patches", patches)->capture_default_str();
  app.add_option("--hemicube", options.hemicube.resolution)->capture_default_str();
  app.add_option("--cutoff", options.cutoff)->capture_default_str();
  app.add_option("--time", seconds)->capture_default_str();
  app.add_option("--threads", threads)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const Scene scene = load_scene(path).scene;
    ThreadScope scope(threads);
    scope.run([&] { measure(scene, patches, options, seconds); });
  } catch (const std::exception& e) {
    fmt::print(stderr, "radiosity_bench: {}\n", e.what());
    return 1;
  }
}
