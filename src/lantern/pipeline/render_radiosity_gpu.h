// SPDX-License-Identifier: MIT
// Radiosity shot and gathered by OpenGL. [Coombe, Harris & Lastra 2004]
#pragma once

#include "lantern/pipeline/render_job.h"

namespace lantern {

/// Throws Error as render() does, as the making of patches does, and where no usable OpenGL is.
Rendered render_radiosity_gpu(const RenderJob& job);

}  // namespace lantern
