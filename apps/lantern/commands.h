// SPDX-License-Identifier: MIT
// The subcommands: each adds itself to the command line and runs when chosen. Errors leave as
// exceptions; main() turns them into one line and an exit code.
#pragma once

#include <CLI/App.hpp>

#include <stdexcept>

namespace lantern::app {

/// The command line is at fault: exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void add_render(CLI::App& app);
void add_lights(CLI::App& app);
void add_info(CLI::App& app);
void add_compare(CLI::App& app);
void add_bench(CLI::App& app);
void add_bench_frames(CLI::App& bench);
void add_bake(CLI::App& app);

}  // namespace lantern::app
