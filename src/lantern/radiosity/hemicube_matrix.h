// SPDX-License-Identifier: MIT
// The matrix of form factors as hemicubes on the patches find it, at the centre of each or at more
// points where one would mislead: each row adds up to 1, or to what does not escape, exactly;
// reciprocity holds as far as the hemicubes see well.
// [Cohen & Greenberg 1985, The Hemi-Cube, section 6]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/hemicube_rows.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace lantern {

/// From how many points of each element hemicubes look: more than the centre alone where a solid
/// covers a part of it, and where emitters, were nothing between, would fill few pixels.
std::vector<std::size_t> hemicube_points(const Patches& patches, int resolution);

/// Rows not reached before `stop` is set stay 0. `report` is called with the share that is done.
FormFactors hemicube_form_factors(const World& world, const Tracer& tracer, const Patches& patches,
                                  const HemicubeOptions& options, const StopFlag& stop,
                                  const std::function<void(double)>& report = {});

}  // namespace lantern
