// SPDX-License-Identifier: MIT
#include "apps/lantern/methods.h"

#include "apps/lantern/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace lantern::app {
namespace {

struct NamedMethod {
  const char* name;
  std::optional<Method> method;  // none: not in this version
};
constexpr NamedMethod kMethods[] = {
    {"instant-radiosity", Method::kInstantRadiosity},
    {"path", Method::kPath},
    {"radiosity-matrix", Method::kRadiosityMatrix},
    {"radiosity-hemicube", Method::kRadiosityHemicube},
    {"radiosity-progressive", Method::kRadiosityProgressive},
    {"radiosity-gpu", Method::kRadiosityGpu},
};

/// An option that not every method knows, and those that do.
struct SpecialOption {
  const char* name;
  std::vector<Method> methods;
};
const std::vector<SpecialOption>& special_options() {
  static const std::vector<SpecialOption> options = {
      {"--lights", {Method::kInstantRadiosity}},
      {"--reflectivity", {Method::kInstantRadiosity}},
      {"--pool", {Method::kInstantRadiosity}},
      {"--sampler", {Method::kInstantRadiosity}},
      {"--jitter", {Method::kInstantRadiosity}},
      {"--bound", {Method::kInstantRadiosity}},
      {"--compensate", {Method::kInstantRadiosity}},
      {"--lights-from", {Method::kInstantRadiosity}},
      {"--single-rays", {Method::kInstantRadiosity}},
      {"--variance", {Method::kPath}},
      {"--patches",
       {Method::kRadiosityMatrix, Method::kRadiosityHemicube, Method::kRadiosityProgressive,
        Method::kRadiosityGpu}},
      {"--patch-size",
       {Method::kRadiosityMatrix, Method::kRadiosityHemicube, Method::kRadiosityProgressive,
        Method::kRadiosityGpu}},
      {"--solver", {Method::kRadiosityMatrix}},
      {"--time",
       {Method::kInstantRadiosity, Method::kPath, Method::kRadiosityProgressive,
        Method::kRadiosityGpu}},
      {"--refine",
       {Method::kRadiosityMatrix, Method::kRadiosityHemicube, Method::kRadiosityProgressive,
        Method::kRadiosityGpu}},
      {"--hemicube",
       {Method::kRadiosityHemicube, Method::kRadiosityProgressive, Method::kRadiosityGpu}},
      {"--cutoff", {Method::kRadiosityProgressive, Method::kRadiosityGpu}},
      {"--no-ambient", {Method::kRadiosityProgressive, Method::kRadiosityGpu}},
      {"--shadows", {Method::kInstantRadiosity}},
      {"--tile", {Method::kInstantRadiosity}},
      {"--deal-lights", {Method::kInstantRadiosity}},
      {"--volumes", {Method::kInstantRadiosity}},
      {"--show-volumes", {Method::kInstantRadiosity}},
      {"--gl-device", {Method::kInstantRadiosity, Method::kRadiosityHemicube}},
  };
  return options;
}

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const NamedMethod& known : kMethods) names.emplace_back(known.name);
  return names;
}

std::vector<std::string> available_methods() {
  std::vector<std::string> names;
  for (const NamedMethod& known : kMethods) {
    if (known.method) names.emplace_back(known.name);
  }
  return names;
}

Method method_of(const std::string& name) {
  for (const NamedMethod& known : kMethods) {
    if (name == known.name && known.method) return *known.method;
  }
  throw UsageError(fmt::format("--method {} is not available in this version", name));
}

void refuse_options_of_others(const CLI::App& command, const std::string& method) {
  const Method chosen = method_of(method);
  for (const SpecialOption& option : special_options()) {
    const bool known =
        std::find(option.methods.begin(), option.methods.end(), chosen) != option.methods.end();
    if (!known && command.count(option.name) > 0) {
      throw UsageError(fmt::format("{} means nothing to --method {}", option.name, method));
    }
  }
}

}  // namespace lantern::app
