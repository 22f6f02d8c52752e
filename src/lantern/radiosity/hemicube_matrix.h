// SPDX-License-Identifier: MIT
// The matrix of form factors as hemicubes at the centres of the patches find it: each row adds up
// to 1, or to what does not escape, exactly; reciprocity holds as far as the hemicubes see well.
// [Cohen & Greenberg 1985, The Hemi-Cube, section 6]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/hemicube_rows.h"

#include <functional>

namespace lantern {

/// Rows not reached before `stop` is set stay 0. `report` is called with the share that is done.
FormFactors hemicube_form_factors(const World& world, const Tracer& tracer, const Patches& patches,
                                  const HemicubeOptions& options, const StopFlag& stop,
                                  const std::function<void(double)>& report = {});

}  // namespace lantern
