// SPDX-License-Identifier: MIT
// Pictures by path tracing, pass after pass, and their variance.
#pragma once

#include "lantern/pipeline/render_job.h"

namespace lantern {

/// Throws Error if the scene has no light.
Rendered render_path(const RenderJob& job);

}  // namespace lantern
