// SPDX-License-Identifier: MIT
// The Tracer for checks: every ray against every triangle, in double precision.
#pragma once

#include "lantern/trace/tracer.h"

#include <memory>

namespace lantern {

/// Keeps references to `scene` and `world`.
std::unique_ptr<Tracer> make_brute_force_tracer(const Scene& scene, const World& world);

}  // namespace lantern
