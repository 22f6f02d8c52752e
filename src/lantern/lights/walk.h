// SPDX-License-Identifier: MIT
// The quasi-random walk: paths from the emitters, a light where each starts and wherever it hits.
// [Keller 1997, Instant Radiosity, section 3; docs/lights.md derives the weights]
#pragma once

#include "lantern/lights/emitters.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/sampling/halton.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

struct WalkOptions {
  std::size_t paths = 256;    // N, at least 1
  float reflectivity = 0.5f;  // p in (0, 1): the share of the paths that survives each bounce
  std::size_t pass = 0;       // pass k takes points 1 + kN .. (k+1)N of the point set
  bool jitter = false;        // moves each point by up to the spacing of its generation
  PointSet points;
};

/// How many paths reach each bounce, n[0] = N down to the last that is not 0, and what a path that
/// does is worth. Bounce by bounce n' = floor(p n + u): pass 0 has u = 0 and is Keller's walk; over
/// passes u is equidistributed, so that what the floors cut off in one comes back in others.
struct Survival {
  std::vector<std::size_t> paths;
  std::vector<double> weight;  // 1/n while the next generation cannot be empty, then 1/p more each
};
Survival make_survival(std::size_t paths, float reflectivity, std::size_t pass);

/// Lights of one pass, normalised so that their expected flux at bounce j is that of light
/// reflected j times whatever N, p and the pass. `emitters` must not be empty.
VirtualLights walk(const Scene& scene, const World& world, const Tracer& tracer,
                   const Emitters& emitters, const WalkOptions& options);

/// Area-weighted mean of the squared reflectance, of the channel that has most of it. The walk's
/// variance has no bound for a p below it.
float mean_squared_reflectance(const Scene& scene, const World& world);

}  // namespace lantern
