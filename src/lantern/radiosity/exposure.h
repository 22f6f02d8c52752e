// SPDX-License-Identifier: MIT
// Which sides of the surfaces light can come to: the inside of a closed solid needs no unknowns,
// and what an object stands on must not count the part that it covers. Decided by rays.
#pragma once

#include "lantern/radiosity/patch_mesh.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <cstdint>
#include <vector>

namespace lantern {

/// For each triangle of the world, whether light can come to its front and to its back.
struct LitSides {
  std::vector<bool> front, back;

  bool operator()(std::uint32_t triangle, bool is_front) const {
    return is_front ? front[triangle] : back[triangle];
  }
};

/// Decided for each side of each surface as a whole, that is for what hangs together by edges:
/// walks from it over surfaces of any reflectance look for an emitter. `mesh` is the world's own
/// (see make_patch_mesh()).
LitSides lit_sides(const Scene& scene, const World& world, const PatchMesh& mesh,
                   const Tracer& tracer);

/// Whether a point just above a surface is shut in by sides that no light comes to, as the floor
/// under a box is. `key` chooses the rays.
bool is_covered(const World& world, const LitSides& lit, const Tracer& tracer, const Vec3& position,
                const Vec3& normal, std::uint64_t key);

}  // namespace lantern
