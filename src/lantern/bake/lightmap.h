// SPDX-License-Identifier: MIT
// A solution and an atlas -> the picture that the atlas has places in. Texels in the border of a
// chart hold the light of the chart's nearest point, so that filters find no seam.
#pragma once

#include "lantern/bake/atlas.h"
#include "lantern/bake/solution.h"
#include "lantern/image/image.h"

#include <vector>

namespace lantern {

struct Lightmap {
  Image radiance;               // reflected and emitted; black where no chart is
  std::vector<float> coverage;  // of the surface, in [0, 1]: 0 in its holes; 1 where no chart is
};

Lightmap make_lightmap(const Solution& solution, const Atlas& atlas);

}  // namespace lantern
