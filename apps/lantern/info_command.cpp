// SPDX-License-Identifier: MIT
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
};

void run(Arguments& arguments) {
  arguments.scene.check();
  arguments.scene.quiet = true;  // the description holds the warnings
  const Loaded loaded = arguments.scene.load_scene_now();
  fmt::print("{}", arguments.json ? describe_as_json(loaded) : describe(loaded));
}

}  // namespace

void add_info(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("info", "Tell what a scene holds");
  arguments->scene.add_to(*command);
  command->add_flag("--json", arguments->json, "One JSON object");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
