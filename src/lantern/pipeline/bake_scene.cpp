// SPDX-License-Identifier: MIT
#include "lantern/pipeline/bake_scene.h"

#include "lantern/pipeline/render_job.h"
#include "lantern/pipeline/stopwatch.h"
#include "lantern/radiosity/external_light.h"
#include "lantern/trace/embree.h"

#include <algorithm>
#include <cmath>

namespace lantern {
namespace {

bool is_dark(const std::vector<glm::dvec3>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](const glm::dvec3& v) { return v == glm::dvec3(0.0); });
}

}  // namespace

BakedScene bake_scene(const Scene& scene, const BakeSceneOptions& options, const StopFlag& stop,
                      const ProgressReport& report) {
  const Stopwatch watch;
  const World world = make_traceable_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const Patches patches = make_patches(scene, world, *tracer, options.patches);
  const std::vector<glm::dvec3> external =
      external_irradiance(scene, world, *tracer, patches, stop);
  require_light(!is_dark(patches.emission) || !is_dark(external));

  BakedScene result;
  std::optional<Atlas> atlas;
  if (options.lightmap_size) {
    atlas = make_atlas(world, patches, *options.lightmap_size);
    result.charts = atlas->charts.size();
    result.texels_per_metre = atlas->texels_per_metre;
  }
  ProgressiveRadiosity radiosity(world, *tracer, patches, options.radiosity, external);
  while (!stop.load() && radiosity.shoot()) {
    if (!report) continue;
    // What is unshot falls by about the same factor in the same time.
    const double share = std::log(std::max(radiosity.unshot_share(), options.radiosity.cutoff)) /
                         std::log(options.radiosity.cutoff);
    report({share, watch.seconds() * (1.0 / share - 1.0), radiosity.shots(), "shot"});
  }
  std::vector<glm::dvec3> irradiance = radiosity.irradiance();
  for (glm::dvec3& e : irradiance) e += radiosity.ambient();
  result.patches = patches.size();
  result.shots = radiosity.shots();
  result.unshot_share = radiosity.unshot_share();
  result.seconds_radiosity = watch.seconds();
  result.baked = bake(Solution(scene, world, patches, irradiance), world, atlas ? &*atlas : nullptr,
                      options.bake);
  result.seconds_bake = watch.seconds() - result.seconds_radiosity;
  return result;
}

}  // namespace lantern
