// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/pipeline/bake_scene.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/options.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lantern::app {
namespace {

struct Arguments {
  SceneArguments scene;
  std::string out;
  BakeSceneOptions options;
  std::string into = "both";
  int lightmap_size = 1024;
  bool json = false;
};

void print_json(const BakedScene& scene) {
  const nlohmann::json out = {{"patches", scene.patches},
                              {"shots", scene.shots},
                              {"unshot_share", scene.unshot_share},
                              {"vertices", scene.baked.vertices},
                              {"triangles", scene.baked.triangles},
                              {"charts", scene.charts},
                              {"texels_per_metre", scene.texels_per_metre},
                              {"radiance_of_white", scene.baked.radiance_of_white},
                              {"bytes", scene.baked.file.size()},
                              {"seconds_radiosity", scene.seconds_radiosity},
                              {"seconds_bake", scene.seconds_bake}};
  fmt::print("{}\n", out.dump());
}

void run(Arguments& arguments) {
  arguments.scene.check();
  arguments.options.bake.vertex_colours = arguments.into != "lightmap";
  arguments.options.lightmap_size.reset();
  if (arguments.into != "vertices") arguments.options.lightmap_size = arguments.lightmap_size;
  arguments.options.bake.made_by = "radiosity-progressive";
  if (extension(arguments.out) != ".glb") throw Error(arguments.out + ": only .glb is written");
  require_writable(arguments.out);
  ThreadScope threads(arguments.scene.threads);
  threads.run([&] {
    const StopFlag& stop = stop_on_interrupt();
    const Loaded loaded = arguments.scene.load_scene_now();
    BakedScene scene;
    {
      ProgressBar bar(arguments.scene.quiet);
      scene = bake_scene(loaded.scene, arguments.options, stop,
                         [&](const Progress& p) { bar.show(p); });
    }
    if (stop.load() && !arguments.scene.quiet) {
      warn(fmt::format("stopped early; {:.2g} of the flux is unshot and spread evenly",
                       scene.unshot_share));
    }
    finish_in_peace();
    write_file(arguments.out, scene.baked.file);
    if (arguments.json) print_json(scene);
  });
}

}  // namespace

void add_bake(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  Arguments& a = *arguments;
  BakeSceneOptions& options = a.options;
  CLI::App* command =
      app.add_subcommand("bake", "Write a scene with its light as glTF that needs no lamps");
  a.scene.add_to(*command);
  command->add_option("-o,--output", a.out, "OUT.glb")->required();
  command->add_option("--bake", a.into, "both (two scenes in one file), vertices or lightmap")
      ->check(CLI::IsMember({"both", "vertices", "lightmap"}))
      ->capture_default_str();
  command->add_option("--lightmap", a.lightmap_size, "Texels along its side")
      ->check(CLI::Range(1, 16384))
      ->capture_default_str();
  command
      ->add_option("--exposure", options.bake.exposure,
                   "Stops beyond the brightest reflection being just white")
      ->check(finite(-100.0, 100.0))
      ->capture_default_str();
  CLI::Option* count = command->add_option("--patches", options.patches.count, "Patches at most")
                           ->check(CLI::Range(1, 16'000'000))
                           ->capture_default_str();
  command->add_option("--patch-size", options.patches.size, "Their longest edge in metres")
      ->check(finite(1e-9, 1e9))
      ->excludes(count);
  command
      ->add_option("--cutoff", options.radiosity.cutoff,
                   "Stop shooting when this share of the flux is left")
      ->check(finite(1e-9, 0.999))
      ->capture_default_str();
  command->add_option("--seed", options.radiosity.hemicube.seed, "Another turn of the hemicubes")
      ->capture_default_str();
  command->add_flag("--json", a.json, "Statistics as one JSON object on standard output");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
