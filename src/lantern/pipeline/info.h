// SPDX-License-Identifier: MIT
// What a scene holds, for people and for programs.
#pragma once

#include "lantern/load/load.h"

#include <string>

namespace lantern {

/// A few lines of text that end in a line break.
std::string describe(const Loaded& loaded);

/// The same as one JSON object.
std::string describe_as_json(const Loaded& loaded);

}  // namespace lantern
