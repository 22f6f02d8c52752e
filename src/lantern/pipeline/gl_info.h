// SPDX-License-Identifier: MIT
// What OpenGL is there, for people and for programs. Errors: Error if none can be used.
#pragma once

#include <string>

namespace lantern {

/// A few lines of text that end in a line break.
std::string describe_gl();

/// The same as one JSON object.
std::string describe_gl_as_json();

}  // namespace lantern
