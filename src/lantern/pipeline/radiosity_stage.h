// SPDX-License-Identifier: MIT
// What the radiosity methods share: patches made of the scene, the light that comes to them from no
// patch, and the picture of a solution.
#pragma once

#include "lantern/pipeline/render_job.h"
#include "lantern/radiosity/patches.h"

#include <cstddef>
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

/// Throws Error with the numbers if a matrix between so many elements does not fit in memory:
/// before patches are made with the count that was asked for, and before it is allocated with
/// theirs.
void require_matrix_memory(std::size_t elements);

/// The picture of the elements' irradiance, drawn also after a stop.
Image draw(const RenderJob& job, const Patches& patches, std::span<const glm::dvec3> irradiance);

}  // namespace lantern
