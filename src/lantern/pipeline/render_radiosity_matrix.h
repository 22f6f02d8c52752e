// SPDX-License-Identifier: MIT
// Radiosity by a matrix of form factors, solved, refined where the solution varies, and solved
// again. [Goral et al. 1984]
#pragma once

#include "lantern/pipeline/render_job.h"

namespace lantern {

/// Throws Error as render() does, as the making of patches does, and if the matrix does not fit in
/// memory. Stopped early the picture is that of the last solution that was finished, if any was.
Rendered render_radiosity_matrix(const RenderJob& job);

}  // namespace lantern
