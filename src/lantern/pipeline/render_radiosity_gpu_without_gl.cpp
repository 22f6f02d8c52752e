// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/pipeline/render_radiosity_gpu.h"

namespace lantern {

Rendered render_radiosity_gpu(const RenderJob&) {
  throw Error("no usable OpenGL: built without it (LANTERN_WITH_GL)");
}

}  // namespace lantern
