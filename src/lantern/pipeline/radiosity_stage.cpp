// SPDX-License-Identifier: MIT
#include "lantern/pipeline/radiosity_stage.h"

#include "lantern/core/error.h"
#include "lantern/core/memory.h"
#include "lantern/radiosity/display.h"
#include "lantern/radiosity/external_light.h"
#include "lantern/radiosity/form_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lantern {

RadiosityStage::RadiosityStage(const RenderJob& job)
    : RadiosityStage(
          job, make_patches(job.scene, job.world, job.tracer, job.options.radiosity.patches)) {}

RadiosityStage::RadiosityStage(const RenderJob& job, Patches made)
    : patches(std::move(made)),
      external(external_irradiance(job.scene, job.world, job.tracer, patches, job.stop)) {
  const auto is_lit = [](const glm::dvec3& value) { return value != glm::dvec3(0.0); };
  require_light(job.scene.sky || !job.scene.lights.empty() ||
                std::any_of(patches.emission.begin(), patches.emission.end(), is_lit));
}

void require_matrix_memory(std::size_t elements, std::uint64_t bytes_beside) {
  require_memory(FormFactors::bytes(elements) + bytes_beside,
                 fmt::format("the matrix between {} patches", elements),
                 "take fewer or larger patches, or radiosity-progressive");
}

std::size_t least_elements(const RenderJob& job) {
  const PatchOptions& options = job.options.radiosity.patches;
  if (!options.size) return std::max(options.count, job.world.size());
  double area = 0.0;
  for (std::uint32_t t = 0; t < job.world.size(); ++t) {
    area += static_cast<double>(job.world.area(t));
  }
  const double largest = 0.25 * std::sqrt(3.0) * *options.size * *options.size;
  constexpr double kMost = 1e9;  // whose square is still a number of bytes
  return std::max(job.world.size(), static_cast<std::size_t>(std::min(area / largest, kMost)));
}

Image draw(const RenderJob& job, const Patches& patches, std::span<const glm::dvec3> irradiance) {
  const Display display(job.scene, job.world, patches);
  const StopFlag never{false};
  return display.draw(
      job.camera, irradiance,
      {.width = job.options.width, .height = job.options.height, .samples = job.options.samples},
      never);
}

}  // namespace lantern
