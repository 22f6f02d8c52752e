// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/core/version.h"
#include "lantern/image/compare.h"
#include "lantern/image/difference.h"
#include "lantern/image/flip.h"
#include "lantern/image/read.h"
#include "lantern/image/write.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace lantern::app {
namespace {

struct Arguments {
  std::string a, b;
  float exposure = 0.0f;
  std::string tone = "plain";
  double pixels_per_degree = FlipOptions{}.pixels_per_degree;
  std::string difference;
  float difference_scale = 0.1f;
  std::string flip_map;
  bool json = false;
};

FlipOptions flip_options(const Arguments& arguments) {
  FlipOptions options;
  options.tone = {arguments.exposure,
                  arguments.tone == "filmic" ? ToneCurve::kFilmic : ToneCurve::kPlain};
  options.pixels_per_degree = arguments.pixels_per_degree;
  return options;
}

bool is_png(const std::string& path) { return extension(path) == ".png"; }

void check_outputs(const Arguments& arguments) {
  for (const std::string& out : {arguments.difference, arguments.flip_map}) {
    if (out.empty()) continue;
    require_image_format(out);
    require_writable(out);
  }
  if (extension(arguments.difference) == ".hdr") {
    throw Error(arguments.difference + ": differences can be negative, HDR keeps no such values");
  }
}

void write_maps(const Arguments& arguments, const Image& a, const Image& b, const Flip& flipped) {
  WriteOptions options;
  options.exr_depth = ExrDepth::kFloat;
  options.metadata = {{"software", std::string("lantern ") + kVersion},
                      {"picture", std::filesystem::path(arguments.a).filename().string()},
                      {"reference", std::filesystem::path(arguments.b).filename().string()}};
  if (!arguments.difference.empty()) {
    const bool painted = is_png(arguments.difference);
    if (painted)
      options.metadata["difference-scale"] = fmt::format("{}", arguments.difference_scale);
    write_image(arguments.difference,
                painted ? paint_difference(a, b, arguments.difference_scale) : difference(a, b),
                options);
  }
  if (!arguments.flip_map.empty()) {
    options.metadata.erase("difference-scale");
    options.metadata["exposure"] = fmt::format("{}", arguments.exposure);
    options.metadata["tone"] = arguments.tone;
    options.metadata["pixels-per-degree"] = fmt::format("{}", arguments.pixels_per_degree);
    const auto draw = is_png(arguments.flip_map) ? paint_errors : grey_errors;
    write_image(arguments.flip_map, draw(flipped.error, a.width, a.height), options);
  }
}

void run(const Arguments& arguments) {
  check_outputs(arguments);
  const Image a = read_image(arguments.a), b = read_image(arguments.b);
  const Comparison c = compare(a, b);
  const Flip flipped = flip(a, b, flip_options(arguments));
  write_maps(arguments, a, b, flipped);
  if (arguments.json) {
    const nlohmann::json out = {{"rmse", c.rmse},
                                {"relmse", c.relmse},
                                {"flip", flipped.mean},
                                {"max_difference", c.max_difference},
                                {"mean_a", {c.mean_a.r, c.mean_a.g, c.mean_a.b}},
                                {"mean_b", {c.mean_b.r, c.mean_b.g, c.mean_b.b}}};
    fmt::print("{}\n", out.dump());
    return;
  }
  fmt::print("rmse            {:.6g}\nrelmse          {:.6g}\nflip            {:.6g}\n", c.rmse,
             c.relmse, flipped.mean);
  fmt::print("max difference  {:.6g}\n", c.max_difference);
  fmt::print("mean a          {:.6g} {:.6g} {:.6g}\nmean b          {:.6g} {:.6g} {:.6g}\n",
             c.mean_a.r, c.mean_a.g, c.mean_a.b, c.mean_b.r, c.mean_b.g, c.mean_b.b);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  Arguments& a = *arguments;
  CLI::App* command = app.add_subcommand("compare", "Tell how far a picture is from a reference");
  command->add_option("a", a.a, "The picture")->required();
  command->add_option("b", a.b, "The reference")->required();
  command->add_option("--exposure", a.exposure, "Stops, for FLIP, which sees what a screen shows")
      ->check(finite(-100.0, 100.0))
      ->capture_default_str();
  command->add_option("--tone", a.tone, "plain or filmic, for FLIP")
      ->check(CLI::IsMember({"plain", "filmic"}))
      ->capture_default_str();
  command
      ->add_option("--pixels-per-degree", a.pixels_per_degree,
                   "Pixels in a degree of the viewer's sight, for FLIP")
      ->check(finite(1.0, 1000.0))
      ->capture_default_str();
  command->add_option(
      "--difference", a.difference,
      "Write a - b to this EXR or PFM, or as red (a brighter) and blue to this PNG");
  command
      ->add_option("--difference-scale", a.difference_scale,
                   "Relative difference that has the full colour in the PNG")
      ->check(finite(1e-6, 1e6))
      ->capture_default_str();
  command->add_option("--flip-map", a.flip_map, "Write FLIP's error of each pixel to this picture");
  command->add_flag("--json", a.json, "One JSON object");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
