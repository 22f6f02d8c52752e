// SPDX-License-Identifier: MIT
// What the radiosity methods share: patches made of the scene, the light that comes to them from no
// patch, and the picture of a solution.
#pragma once

#include "lantern/pipeline/render_job.h"
#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

struct RadiosityStage {
  Patches patches;
  std::vector<glm::dvec3> external;  // irradiance by points, spots, the sun and the sky

  /// Throws Error if the scene has no light, and as make_patches() does.
  explicit RadiosityStage(const RenderJob& job);
  /// The same on patches made otherwise.
  RadiosityStage(const RenderJob& job, Patches made);
};

/// Throws Error with the numbers if a matrix between so many elements and what else is needed
/// beside it do not fit in memory.
void require_matrix_memory(std::size_t elements, std::uint64_t bytes_beside = 0);

/// The fewest elements that the options can lead to, known before patches are made: as many as are
/// asked for, or as can cover the scene with equilateral patches of the longest edge allowed.
std::size_t least_elements(const RenderJob& job);

/// The picture of the elements' irradiance, drawn also after a stop.
Image draw(const RenderJob& job, const Patches& patches, std::span<const glm::dvec3> irradiance);

}  // namespace lantern
