// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/pipeline/gl_items.h"

namespace lantern {

std::unique_ptr<HemicubePainter> make_gl_painter(const RenderJob&) {
  throw Error("no usable OpenGL: built without it (LANTERN_WITH_GL)");
}

}  // namespace lantern
