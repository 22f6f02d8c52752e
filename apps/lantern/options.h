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
#include <functional>
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
  std::optional<SkyEdit> sky_;
};

/// Which camera.
struct CameraArguments {
  std::string name;
  std::string look_at;
  float fov = 0.0f;  // degrees; 0: not given

  void add_to(CLI::App& command);
  /// Throws UsageError.
  CameraChoice choice() const;
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

/// Runs `require` on the name of a file to write. A format that is asked for and cannot be written
/// is wrong usage; a name that asks for none (a device, say) is an error like any other.
void check_format(const std::filesystem::path& out,
                  const std::function<void(const std::filesystem::path&)>& require);

/// Throws UsageError if `out` is one of the files that are read.
void require_other_file(const std::filesystem::path& out, const std::filesystem::path& read);

/// "WxH". Throws UsageError.
std::pair<int, int> parse_size(const std::string& text);

}  // namespace lantern::app
