// SPDX-License-Identifier: MIT
// Radiosity by a matrix whose rows hemicubes find. [Cohen & Greenberg 1985]
#pragma once

#include "lantern/pipeline/render_job.h"

namespace lantern {

/// Throws Error as render() does, and as the making of patches does.
Rendered render_radiosity_hemicube(const RenderJob& job);

}  // namespace lantern
