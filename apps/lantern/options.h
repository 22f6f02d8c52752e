// SPDX-License-Identifier: MIT
// Options that several subcommands share.
#pragma once

#include "lantern/load/load.h"
#include "lantern/pipeline/edits.h"
#include "lantern/pipeline/render.h"

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lantern::app {

/// Which scene, and what is changed in it once it is loaded.
struct SceneArguments {
  std::filesystem::path path;
  LoadOptions load;
  std::vector<std::string> emitters;
  std::string sky;
  bool quiet = false;
  int threads = 0;

  void add_to(CLI::App& command);
  /// Parses what can be wrong in the options, before anything is loaded. Throws UsageError.
  void check();
  /// Loads and edits the scene; warnings go to standard error unless `quiet`.
  Loaded load_scene_now() const;

 private:
  std::vector<EmitterEdit> edits_;
};

/// How lights are made.
struct LightArguments {
  std::size_t paths = 0;  // 0: not given
  std::size_t pool = 0;   // likewise
  std::string reflectivity = "auto";
  std::string sampler = "halton";
  bool jitter = false;
  std::uint64_t seed = 0;

  void add_to(CLI::App& command);
  /// Throws UsageError.
  LightOptions options(std::size_t default_paths, std::size_t default_pool) const;
};

/// Accepts a finite number in [low, high].
CLI::Validator finite(double low, double high);

/// "WxH". Throws UsageError.
std::pair<int, int> parse_size(const std::string& text);

}  // namespace lantern::app
