// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/pipeline/frames.h"

namespace lantern {

FramePoint measure_frames(const Scene&, const FrameRun&, const VirtualLights&, double,
                          const StopFlag&) {
  throw Error("no usable OpenGL: built without it (LANTERN_WITH_GL)");
}

}  // namespace lantern
