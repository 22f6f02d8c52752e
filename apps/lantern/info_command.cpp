// SPDX-License-Identifier: MIT
#include "lantern/pipeline/gl_info.h"
#include "lantern/pipeline/info.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

namespace lantern::app {
namespace {

struct Arguments {
  SceneArguments scene;
  bool json = false;
  bool gl = false;
};

void run(Arguments& arguments) {
  if (arguments.gl) {
    fmt::print("{}", arguments.json ? describe_gl_as_json() : describe_gl());
    return;
  }
  if (arguments.scene.path.empty()) throw UsageError("scene is required, or --gl");
  arguments.scene.check();
  arguments.scene.quiet = true;  // the description holds the warnings
  const Loaded loaded = arguments.scene.load_scene_now();
  fmt::print("{}", arguments.json ? describe_as_json(loaded) : describe(loaded));
}

}  // namespace

void add_info(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("info", "Tell what a scene holds, or what OpenGL is there");
  arguments->scene.add_to(*command);
  command->get_option("scene")->required(false);
  command->add_flag("--gl", arguments->gl, "Tell what OpenGL was found, instead")
      ->excludes(command->get_option("scene"));
  command->add_flag("--json", arguments->json, "One JSON object");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
