// SPDX-License-Identifier: MIT
// A scene to a binary glTF file that shows its light: patches, progressive radiosity, and what
// bake/bake.h makes of the solution.
#pragma once

#include "lantern/bake/bake.h"
#include "lantern/pipeline/render.h"
#include "lantern/radiosity/progressive.h"

#include <cstddef>
#include <optional>

namespace lantern {

struct BakeSceneOptions {
  PatchOptions patches{.count = 20'000};
  ProgressiveOptions radiosity;
  std::optional<int> lightmap_size = 1024;  // texels along a side; none: no lightmap
  BakeOptions bake;
};

struct BakedScene {
  Baked baked;
  std::size_t patches = 0;
  std::size_t charts = 0;  // of the lightmap, like the next
  double texels_per_metre = 0.0;
  std::size_t shots = 0;
  double unshot_share = 0.0;  // of the flux emitted; the ambient term stands for it
  double seconds_radiosity = 0.0;
  double seconds_bake = 0.0;
};

/// Once `stop` is set no more light is shot, and what is there is baked. Throws Error if the scene
/// has no triangles or no light, and as make_patches(), make_atlas() and bake() do.
BakedScene bake_scene(const Scene& scene, const BakeSceneOptions& options, const StopFlag& stop,
                      const ProgressReport& report = {});

}  // namespace lantern
