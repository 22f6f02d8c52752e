// SPDX-License-Identifier: MIT
// Hemicubes drawn by GL for the methods that draw them with rays; in builds without GL an Error.
#pragma once

#include "lantern/pipeline/render_job.h"
#include "lantern/radiosity/hemicube.h"

#include <memory>

namespace lantern {

/// With a GL context of its own, current as long as it lives. Throws Error where no GL is usable
/// and for surfaces with holes.
std::unique_ptr<HemicubePainter> make_gl_painter(const RenderJob& job);

}  // namespace lantern
