// SPDX-License-Identifier: MIT
// Pictures from many small lights, pass after pass. [Keller 1997, Instant Radiosity]
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/pipeline/render_job.h"

#include <string>
#include <vector>

namespace lantern {

/// Throws Error if the scene has no light.
Rendered render_instant_radiosity(const RenderJob& job);

/// The lights of pass 0 alone. Warnings are appended. Throws Error if the scene has no triangles or
/// no light.
VirtualLights make_lights(const Scene& scene, const LightOptions& options,
                          std::vector<std::string>& warnings);

}  // namespace lantern
