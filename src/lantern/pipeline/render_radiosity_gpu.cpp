// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_radiosity_gpu.h"

#include "lantern/gl/context.h"
#include "lantern/pipeline/shooting.h"
#include "lantern/radiosity_gl/gpu_radiosity.h"
#include "lantern/scene/surface.h"

#include <fmt/format.h>

namespace lantern {
namespace {

/// What Coombe et al. refine texels for; as for the matrix.
constexpr int kRefinements = 2;

/// Finer hemicubes tell more of each shot, and are worth more shots: the limits are those of the
/// usual resolution and tighten with it, so that it sets the quality of all.
ShotLimits limits_for(int resolution) {
  ShotLimits limits;
  const double finer = static_cast<double>(resolution) / HemicubeOptions{}.resolution;
  limits.share /= finer;
  limits.spread /= finer * finer;
  limits.radius /= finer;
  return limits;
}

void warn_of_holes(const Scene& scene, std::vector<std::string>& warnings) {
  for (const Material& material : scene.materials) {
    if (!has_holes(material)) continue;
    warnings.push_back(
        fmt::format("material '{}' has holes; radiosity-gpu lets no light through", material.name));
  }
}

}  // namespace

Rendered render_radiosity_gpu(const RenderJob& job) {
  const gl::Context context;
  const RadiosityOptions& options = job.options.radiosity;
  const auto solve = [&](const RadiosityStage& stage, RadiosityStatistics& statistics) {
    GpuRadiosity radiosity(job.world, job.tracer, stage.patches, stage.external,
                           {.hemicube = options.hemicube.resolution,
                            .cutoff = options.cutoff,
                            .limits = limits_for(options.hemicube.resolution),
                            .seed = options.hemicube.seed});
    RadiositySolution solution = shoot(job, radiosity, statistics);
    statistics.hemicubes = radiosity.shots();
    return solution;
  };
  Rendered result = render_in_rounds(job, kRefinements, solve);
  warn_of_holes(job.scene, result.warnings);
  return result;
}

}  // namespace lantern
