// SPDX-License-Identifier: MIT
// How test names say which GL they ran on.
#pragma once

#include "lantern/gl/context.h"

#include <ostream>

namespace lantern::gl {

inline void PrintTo(Api api, std::ostream* out) { *out << (api == Api::kEs ? "ES" : "desktop"); }

}  // namespace lantern::gl
