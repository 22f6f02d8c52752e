// SPDX-License-Identifier: MIT
#include "lantern/core/version.h"

#include "apps/lantern/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <csignal>
#include <exception>
#include <new>

namespace {

constexpr int kFailure = 1;
constexpr int kWrongUsage = 2;

/// Commands of the design that other parts of the system will bring.
void add_later(CLI::App& app, const char* name, const char* what) {
  CLI::App* command = app.add_subcommand(name, what);
  command->allow_extras();
  command->callback([name] {
    throw lantern::app::UsageError(fmt::format("'{}' is not available in this version", name));
  });
}

int run(int argc, char** argv) {
  CLI::App app(
      "Lantern, an instant radiosity renderer: many small lights, one noise-free picture.");
  app.set_version_flag("--version", std::string("lantern ") + lantern::kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  lantern::app::add_render(app);
  lantern::app::add_lights(app);
  lantern::app::add_info(app);
  lantern::app::add_compare(app);
  lantern::app::add_bench(app);
  lantern::app::add_bake(app);
  add_later(app, "view", "Open a scene in a window (not in this version)");
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    fmt::print(stderr, "lantern: {} (see --help)\n", e.what());
    return kWrongUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // A file that grows too large is an error to report, not an end without a word.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const lantern::app::UsageError& e) {
    fmt::print(stderr, "lantern: {} (see --help)\n", e.what());
    return kWrongUsage;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "lantern: out of memory\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "lantern: {}\n", e.what());
  }
  return kFailure;
}
