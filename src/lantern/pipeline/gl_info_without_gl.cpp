// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/pipeline/gl_info.h"

namespace lantern {
namespace {

constexpr const char* kWithout = "no usable OpenGL: built without it (LANTERN_WITH_GL)";

}  // namespace

std::string describe_gl() { throw Error(kWithout); }

std::string describe_gl_as_json() { throw Error(kWithout); }

}  // namespace lantern
