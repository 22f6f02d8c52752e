// SPDX-License-Identifier: MIT
// The Tracer for work: Embree, hidden behind this one file.
#pragma once

#include "lantern/trace/tracer.h"

#include <memory>

namespace lantern {

/// Keeps references to `scene` and `world`. Throws Error if Embree cannot build its tree.
std::unique_ptr<Tracer> make_embree_tracer(const Scene& scene, const World& world);

}  // namespace lantern
