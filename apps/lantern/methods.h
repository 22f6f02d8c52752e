// SPDX-License-Identifier: MIT
// The methods of `render` by name, and which options each of them knows.
#pragma once

#include "lantern/pipeline/render.h"

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace lantern::app {

/// Samples of a pass by path tracing where passes fill a given time: few enough to keep to it,
/// enough to be well spread.
inline constexpr int kPathSamplesInTime = 16;

/// What --method takes, also what is not in this version.
std::vector<std::string> method_names();

/// Those that are in this version.
std::vector<std::string> available_methods();

/// Throws UsageError for a method that is not in this version.
Method method_of(const std::string& name);

/// Throws UsageError if an option is given that means nothing to the method.
void refuse_options_of_others(const CLI::App& command, const std::string& method);

}  // namespace lantern::app
