// SPDX-License-Identifier: MIT
// Radiosity by shooting, best first: every moment has a picture. [Cohen et al. 1988]
#pragma once

#include "lantern/pipeline/render_job.h"

namespace lantern {

/// Throws Error as render() does, and as the making of patches does.
Rendered render_radiosity_progressive(const RenderJob& job);

}  // namespace lantern
