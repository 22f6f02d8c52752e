// SPDX-License-Identifier: MIT
// A radiosity solution -> a binary glTF file that viewers show lit without any light of their own
// (KHR_materials_unlit). Scene 0 has the light as vertex colours, times the surfaces' textures;
// scene 1 as a lightmap on the second set of texture coordinates, textures included. They stand in
// two scenes since a viewer multiplies all that one primitive has.
#pragma once

#include "lantern/bake/atlas.h"
#include "lantern/bake/solution.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lantern {

struct BakeOptions {
  bool vertex_colours = true;  // else the lightmap is all there is
  float exposure = 0.0f;       // stops beyond that at which the brightest reflection is just white
  std::string made_by;         // the method, for the file's extras
};

struct Baked {
  std::vector<std::byte> file;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t charts = 0;  // without a lightmap 0, like the next
  double texels_per_metre = 0.0;
  float radiance_of_white = 0.0f;  // W/(m² sr) that the colour 1 stands for, in `extras` as well
};

/// Colours are radiance over `radiance_of_white`, clipped to [0, 1]. Without an atlas there is no
/// lightmap. Throws Error if the file would be too large for the format.
Baked bake(const Solution& solution, const World& world, const Atlas* atlas,
           const BakeOptions& options);

}  // namespace lantern
