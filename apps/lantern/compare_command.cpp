// SPDX-License-Identifier: MIT
#include "lantern/image/compare.h"
#include "lantern/image/read.h"

#include "apps/lantern/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace lantern::app {
namespace {

struct Arguments {
  std::string a, b;
  bool json = false;
};

void run(const Arguments& arguments) {
  const Image a = read_image(arguments.a);
  const Comparison c = compare(a, read_image(arguments.b));
  if (arguments.json) {
    const nlohmann::json out = {{"rmse", c.rmse},
                                {"relmse", c.relmse},
                                {"max_difference", c.max_difference},
                                {"mean_a", {c.mean_a.r, c.mean_a.g, c.mean_a.b}},
                                {"mean_b", {c.mean_b.r, c.mean_b.g, c.mean_b.b}}};
    fmt::print("{}\n", out.dump());
    return;
  }
  fmt::print("rmse            {:.6g}\nrelmse          {:.6g}\nmax difference  {:.6g}\n", c.rmse,
             c.relmse, c.max_difference);
  fmt::print("mean a          {:.6g} {:.6g} {:.6g}\nmean b          {:.6g} {:.6g} {:.6g}\n",
             c.mean_a.r, c.mean_a.g, c.mean_a.b, c.mean_b.r, c.mean_b.g, c.mean_b.b);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("compare", "Tell how far a picture is from a reference");
  command->add_option("a", arguments->a, "The picture")->required();
  command->add_option("b", arguments->b, "The reference")->required();
  command->add_flag("--json", arguments->json, "One JSON object");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace lantern::app
