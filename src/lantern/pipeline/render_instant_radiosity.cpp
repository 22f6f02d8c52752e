// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_instant_radiosity.h"

#include "lantern/core/error.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/resample.h"
#include "lantern/pipeline/gl_gather.h"
#include "lantern/pipeline/passes.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include <algorithm>
#include <numbers>

namespace lantern {
namespace {

/// The scene as walks see it.
struct WalkInput {
  const Scene& scene;
  const World& world;
  const Tracer& tracer;
  const Emitters& emitters;
};

/// Paths that all survive would never end, and without survivors nothing is reflected: scenes of
/// mirrors or of soot stay inside these limits.
constexpr float kLeastReflectivity = 0.05f;
constexpr float kMostReflectivity = 0.95f;

WalkOptions walk_options(const Scene& scene, const World& world, const LightOptions& options,
                         std::vector<std::string>& warnings) {
  WalkOptions walk;
  walk.paths = options.paths;
  walk.jitter = options.jitter;
  walk.points = options.points;
  walk.reflectivity = options.reflectivity.value_or(
      std::clamp(mean_reflectivity(scene, world), kLeastReflectivity, kMostReflectivity));
  const float least = mean_squared_reflectance(scene, world);
  if (walk.reflectivity < least) {
    warnings.push_back(
        fmt::format("a reflectivity of {:.3g} is below the mean squared reflectance {:.3g}: the "
                    "walk's variance "
                    "has no bound; expect bright dots, or raise --reflectivity",
                    walk.reflectivity, least));
  }
  return walk;
}

/// The lights of one pass: all that the walk leaves, or the pick of a larger walk.
VirtualLights lights_of_pass(const WalkInput& in, WalkOptions walk_with, std::size_t pool,
                             std::size_t pass) {
  walk_with.pass = pass;
  if (pool <= 1) return walk(in.scene, in.world, in.tracer, in.emitters, walk_with);
  std::size_t count = 0;
  for (const std::size_t n : make_survival(walk_with.paths, walk_with.reflectivity, 0).paths) {
    count += n;
  }
  const std::size_t paths = walk_with.paths;
  const double radius = static_cast<double>(in.world.bounds.radius());
  const double disc = std::numbers::pi * radius * radius;
  walk_with.paths *= pool;
  VirtualLights lights =
      resample(walk(in.scene, in.world, in.tracer, in.emitters, walk_with), count, pass, disc);
  lights.paths = paths;
  return lights;
}

using PixelsDone = std::function<void(std::size_t)>;
using GatherPass =
    std::function<Image(const VirtualLights& lights, std::size_t pass, const PixelsDone& done)>;

GatherPass make_gather(const RenderJob& job, const Emitters& emitters, GatherCounts& rays) {
  const RenderOptions& options = job.options;
  if (options.backend == Backend::kGl) {
    const auto by_gl = std::make_shared<GlGather>(job, emitters);
    return [by_gl](const VirtualLights& lights, std::size_t pass, const PixelsDone& done) {
      return by_gl->gather(lights, pass, done);
    };
  }
  GatherOptions gather_with;
  gather_with.width = options.width;
  gather_with.height = options.height;
  gather_with.samples = options.samples;
  gather_with.bound = options.bound;
  gather_with.compensate = options.compensate;
  gather_with.seed = options.lights.points.seed;
  gather_with.shadow_rays = options.shadow_rays;
  return [&, gather_with](const VirtualLights& lights, std::size_t pass,
                          const PixelsDone& done) mutable {
    gather_with.pass = pass;
    const GatherInput input{job.scene, job.world, job.tracer, emitters, job.camera};
    return gather(input, lights, gather_with, rays, job.stop, done);
  };
}

}  // namespace

Rendered render_instant_radiosity(const RenderJob& job) {
  const RenderOptions& options = job.options;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  const Emitters emitters(job.scene, job.world);
  if (!options.given_lights) require_light(!emitters.empty());
  const WalkInput walk_in{job.scene, job.world, job.tracer, emitters};
  const WalkOptions walk_with = walk_options(job.scene, job.world, options.lights, result.warnings);
  GatherCounts rays;
  const GatherPass gather_pass = make_gather(job, emitters, rays);
  statistics.seconds_prepare = job.watch.seconds();

  Passes passes(job);
  while (passes.next()) {
    const Stopwatch lights_watch;
    VirtualLights walked;
    if (!options.given_lights) {
      walked = lights_of_pass(walk_in, walk_with, options.lights.pool, passes.number());
    }
    const VirtualLights& lights = options.given_lights ? *options.given_lights : walked;
    statistics.seconds_lights += lights_watch.seconds();

    const Stopwatch gather_watch;
    const Image image = gather_pass(lights, passes.number(),
                                    [&](std::size_t pixels) { passes.pixels_done(pixels); });
    statistics.seconds_gather += gather_watch.seconds();
    if (!passes.add(image)) break;
    statistics.lights += lights.size();
    statistics.paths += lights.paths;
    statistics.reflectivity = lights.reflectivity;
  }
  statistics.passes = passes.count();
  statistics.rays = {.camera_rays = rays.camera_rays,
                     .shadow_rays = rays.shadow_rays,
                     .compensation_rays = rays.compensation_rays};
  result.image = passes.mean();
  return result;
}

VirtualLights make_lights(const Scene& scene, const LightOptions& options,
                          std::vector<std::string>& warnings) {
  const World world = make_traceable_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const Emitters emitters(scene, world);
  require_light(!emitters.empty());
  return lights_of_pass({scene, world, *tracer, emitters},
                        walk_options(scene, world, options, warnings), options.pool, 0);
}

}  // namespace lantern
