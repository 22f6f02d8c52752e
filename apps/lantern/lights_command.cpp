// SPDX-License-Identifier: MIT
#include "lantern/core/file.h"
#include "lantern/lights/export.h"
#include "lantern/pipeline/render_instant_radiosity.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/options.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>

namespace lantern::app {
namespace {

constexpr std::size_t kUsualPaths = 256;

struct Arguments {
  SceneArguments scene;
  LightArguments lights;
  std::string out;
};

void run(Arguments& arguments) {
  arguments.scene.check();
  const LightOptions options = arguments.lights.options(kUsualPaths, 1);
  check_format(arguments.out, require_lights_format);
  require_other_file(arguments.out, arguments.scene.path);
  require_writable(arguments.out);
  ThreadScope threads(arguments.scene.threads);
  threads.run([&] {
    const Loaded loaded = arguments.scene.load_scene_now();
    std::vector<std::string> warnings;
    const VirtualLights lights = make_lights(loaded.scene, options, warnings);
    if (!arguments.scene.quiet) {
      for (const std::string& warning : warnings) warn(warning);
    }
    write_lights(arguments.out, lights, loaded.scene.origin);
  });
}

}  // namespace

void add_lights(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("lights", "Write a scene's virtual lights to a file");
  arguments->scene.add_to(*command);
  arguments->lights.add_to(*command);
  command->add_option("-o,--output", arguments->out, "OUT.json, OUT.ply or OUT.gltf")->required();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
