// SPDX-License-Identifier: MIT
#include "apps/lantern/options.h"

#include "lantern/core/error.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

namespace lantern::app {

void SceneArguments::add_to(CLI::App& command) {
  command
      .add_option("scene", path,
                  "Ogre .mesh.xml, .mesh or .scene, glTF/GLB, OBJ, or what assimp reads")
      ->required();
  command
      .add_option("--materials", load.material_scripts,
                  "Ogre material script beside those next to the scene (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--unit", load.unit, "Metres per unit of the file")
      ->check(finite(1e-9, 1e9))
      ->capture_default_str();
  command
      .add_option("--emitter", emitters,
                  "PATTERN=R,G,B: materials whose name matches emit that radiance (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--sky", sky, "R,G,B or a lat-long picture: radiance from all around");
  command.add_option("--threads", threads, "Threads to use (0: all cores)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_flag("--quiet", quiet, "No progress and no warnings");
}

void SceneArguments::check() {
  try {
    for (const std::string& text : emitters) edits_.push_back(parse_emitter(text));
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("--emitter: ") + e.what());
  }
  try {
    if (!sky.empty()) sky_ = parse_sky(sky);
  } catch (const std::invalid_argument& e) {
    throw UsageError(e.what());
  }
}

Loaded SceneArguments::load_scene_now() const {
  Loaded loaded = load_scene(path, load);
  for (const EmitterEdit& edit : edits_) apply(edit, loaded.scene);
  if (sky_) set_sky(*sky_, loaded.scene);
  if (!quiet) {
    for (const std::string& warning : loaded.report.warnings) warn(warning);
    for (const auto& [what, times] : loaded.report.unknown) {
      warn(fmt::format("{}: unknown, ignored ({} times)", what, times));
    }
  }
  return loaded;
}

void CameraArguments::add_to(CLI::App& command) {
  command.add_option("--camera", name, "Name of a camera of the scene");
  command.add_option("--look-at", look_at, "ex,ey,ez,tx,ty,tz[,ux,uy,uz]: eye, target, up");
  command.add_option("--fov", fov, "Vertical field of view in degrees")->check(finite(0.01, 179.0));
}

CameraChoice CameraArguments::choice() const {
  CameraChoice camera;
  camera.name = name;
  if (fov > 0.0f) camera.vertical_fov = glm::radians(fov);
  if (look_at.empty()) return camera;
  try {
    const std::vector<float> v = parse_numbers(look_at);
    if (v.size() != 6 && v.size() != 9) throw std::invalid_argument("needs 6 or 9 numbers");
    camera.eye = Vec3(v[0], v[1], v[2]);
    camera.target = Vec3(v[3], v[4], v[5]);
    if (v.size() == 9) camera.up = Vec3(v[6], v[7], v[8]);
    const Vec3 right = glm::cross(camera.target - *camera.eye, camera.up);
    if (!(glm::dot(right, right) > 0.0f)) {
      throw std::invalid_argument("eye, target and up must not lie on one line");
    }
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("--look-at: ") + e.what());
  }
  return camera;
}

void LightArguments::add_to(CLI::App& command) {
  command.add_option("--lights", paths, "Light paths started in a pass")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  command
      .add_option("--reflectivity", reflectivity,
                  "Share of the paths that survives a bounce, in (0, 1), or auto: the scene's mean")
      ->capture_default_str();
  command.add_option("--sampler", sampler, "halton, scrambled (every dimension) or random")
      ->check(CLI::IsMember({"halton", "scrambled", "random"}))
      ->capture_default_str();
  command
      .add_option("--pool", pool,
                  "Walk so many times the paths and keep the lights that matter most (1; with "
                  "several passes 16)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000}));
  command.add_flag("--jitter", jitter, "Jitter each point within the spacing of its generation");
  command.add_option("--seed", seed, "Another seed, another set of points")->capture_default_str();
}

LightOptions LightArguments::options(std::size_t default_paths, std::size_t default_pool) const {
  LightOptions lights;
  lights.paths = paths > 0 ? paths : default_paths;
  lights.pool = pool > 0 ? pool : default_pool;
  lights.jitter = jitter;
  lights.points.seed = seed;
  lights.points.sampler = sampler == "random"      ? Sampler::kRandom
                          : sampler == "scrambled" ? Sampler::kScrambled
                                                   : Sampler::kHalton;
  if (reflectivity != "auto") {
    try {
      const std::vector<float> value = parse_numbers(reflectivity);
      if (value.size() != 1 || !(value[0] > 0.0f && value[0] < 1.0f)) {
        throw std::invalid_argument("out of range");
      }
      lights.reflectivity = value[0];
    } catch (const std::invalid_argument&) {
      throw UsageError(
          fmt::format("--reflectivity: '{}' is neither a number in (0, 1) nor auto", reflectivity));
    }
  }
  return lights;
}

CLI::Validator finite(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        const char* end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, value);
        if (code == std::errc() && stop == end && value >= low && value <= high) return {};
        return fmt::format("'{}' is not a number in {} to {}", text, low, high);
      },
      fmt::format("in {} to {}", low, high));
}

void check_format(const std::filesystem::path& out,
                  const std::function<void(const std::filesystem::path&)>& require) {
  try {
    require(out);
  } catch (const Error& e) {
    if (!out.has_extension()) throw;
    throw UsageError(e.what());
  }
}

void require_other_file(const std::filesystem::path& out, const std::filesystem::path& read) {
  std::error_code code;
  if (std::filesystem::equivalent(out, read, code)) {
    throw UsageError(fmt::format("{} is read and would be overwritten", out.string()));
  }
}

std::pair<int, int> parse_size(const std::string& text) {
  // Beyond this a picture's floats alone would take 16 GiB.
  constexpr int kLargest = 32768;
  const char* end = text.data() + text.size();
  int width = 0, height = 0;
  const auto first = std::from_chars(text.data(), end, width);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == 'x') {
    const auto second = std::from_chars(first.ptr + 1, end, height);
    if (second.ec == std::errc() && second.ptr == end && width > 0 && height > 0 &&
        width <= kLargest && height <= kLargest) {
      return {width, height};
    }
  }
  throw UsageError(fmt::format("--size: '{}' is not WxH with both in 1 to {}", text, kLargest));
}

}  // namespace lantern::app
