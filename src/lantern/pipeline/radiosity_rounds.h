// SPDX-License-Identifier: MIT
// What the radiosity methods share: a solution on few patches, more patches where it varies, a
// solution on these, and so on; then the picture. With `--patch-size` there is one round.
#pragma once

#include "lantern/pipeline/radiosity_stage.h"

#include <functional>
#include <vector>

namespace lantern {

struct RadiositySolution {
  std::vector<glm::dvec3> irradiance;  // W/m², one for each element
  double missing = 0.0;                // the share of the flux that should be in it and is not
};

/// Solves for the patches of a stage. `statistics` are of this round alone; its number is there.
using SolveRound = std::function<RadiositySolution(const RadiosityStage&, RadiosityStatistics&)>;

/// Each round has twice the patches of the one before; `refinements` are those after the first if
/// the options do not say. Once the job is stopped or out of time none starts, and one that was cut
/// short counts only if it misses no more than the one before.
Rendered render_in_rounds(const RenderJob& job, int refinements, const SolveRound& solve);

/// Whether the time that the job was given has not passed.
bool in_time(const RenderJob& job);

}  // namespace lantern
