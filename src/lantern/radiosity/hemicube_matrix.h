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

namespace lantern {

struct HemicubeMatrix {
  FormFactors factors;
  std::size_t hemicubes = 0;  // more than one for an element that a solid covers in part, where
                              // emitters fill few pixels, and in half shadow
};

/// Rows not reached before `stop` is set stay 0. `report` is called with the share that is done.
HemicubeMatrix hemicube_matrix(const World& world, const Tracer& tracer, const Patches& patches,
                               const HemicubeOptions& options, const StopFlag& stop,
                               const std::function<void(double)>& report = {});

}  // namespace lantern
