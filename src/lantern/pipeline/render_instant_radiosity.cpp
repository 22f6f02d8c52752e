// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render_instant_radiosity.h"

#include "lantern/core/error.h"
#include "lantern/gather/importance.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/resample.h"
#include "lantern/pipeline/gl_gather.h"
#include "lantern/pipeline/passes.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>

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

/// Weighs the lights of a pool for a pass.
using Weigh = std::function<std::vector<double>(const VirtualLights& pool, std::size_t pass)>;

/// What they shine, for a picture that is not known.
std::vector<double> weigh_by_flux(const World& world, const VirtualLights& pool) {
  const double radius = static_cast<double>(world.bounds.radius());
  return flux_weights(pool, std::numbers::pi * radius * radius);
}

/// What they matter to the picture. As that is only seen at some points of it, every light keeps a
/// part of the weight that its flux gives it.
std::vector<double> weigh_by_importance(const GatherInput& input, const VirtualLights& pool,
                                        const GatherOptions& options) {
  constexpr double kByFlux = 0.25;
  std::vector<double> weights = weigh_by_flux(input.world, pool);
  const std::vector<double> seen = importance(input, pool, options);
  const double flux = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double all = std::accumulate(seen.begin(), seen.end(), 0.0);
  if (!(all > 0.0)) return weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = kByFlux * weights[i] / flux + (1.0 - kByFlux) * seen[i] / all;
  }
  return weights;
}

/// The lights of one pass: all that the walk leaves, or the pick of a larger walk.
VirtualLights lights_of_pass(const WalkInput& in, WalkOptions walk_with, std::size_t pool,
                             std::size_t pass, const Weigh& weigh) {
  walk_with.pass = pass;
  if (pool <= 1) return walk(in.scene, in.world, in.tracer, in.emitters, walk_with);
  std::size_t count = 0;
  for (const std::size_t n : make_survival(walk_with.paths, walk_with.reflectivity, 0).paths) {
    count += n;
  }
  const std::size_t paths = walk_with.paths;
  walk_with.paths *= pool;
  const VirtualLights walked = walk(in.scene, in.world, in.tracer, in.emitters, walk_with);
  VirtualLights lights = resample(walked, weigh(walked, pass), count, pass);
  lights.paths = paths;
  return lights;
}

using PixelsDone = std::function<void(std::size_t)>;
using GatherPass =
    std::function<Image(const VirtualLights& lights, std::size_t pass, const PixelsDone& done)>;

GatherOptions gather_options(const RenderOptions& options) {
  GatherOptions gather_with;
  gather_with.width = options.width;
  gather_with.height = options.height;
  gather_with.samples = options.samples;
  gather_with.bound = options.bound;
  gather_with.compensate = options.compensate;
  gather_with.seed = options.lights.points.seed;
  gather_with.shadow_rays = options.shadow_rays;
  return gather_with;
}

/// `rays` and `seconds_gpu` are those of all passes.
GatherPass make_gather(const RenderJob& job, const GatherInput& input, GatherCounts& rays,
                       std::map<std::string, double>& seconds_gpu) {
  if (job.options.backend == Backend::kGl) {
    const auto by_gl = std::make_shared<GlGather>(job, input.emitters);
    return [by_gl, &seconds_gpu](const VirtualLights& lights, std::size_t pass,
                                 const PixelsDone& done) {
      Image image = by_gl->gather(lights, pass, done);
      seconds_gpu = by_gl->seconds_of_stages();
      return image;
    };
  }
  return [&, gather_with = gather_options(job.options)](
             const VirtualLights& lights, std::size_t pass, const PixelsDone& done) mutable {
    gather_with.pass = pass;
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
  const GatherInput input{job.scene, job.world, job.tracer, emitters, job.camera};
  const GatherPass gather_pass = make_gather(job, input, rays, statistics.seconds_gpu);
  const Weigh weigh = [&, gather_with = gather_options(options)](const VirtualLights& pool,
                                                                 std::size_t pass) mutable {
    gather_with.pass = pass;
    return weigh_by_importance(input, pool, gather_with);
  };
  statistics.seconds_prepare = job.watch.seconds();

  Passes passes(job);
  while (passes.next()) {
    const Stopwatch lights_watch;
    VirtualLights walked;
    if (!options.given_lights) {
      walked = lights_of_pass(walk_in, walk_with, options.lights.pool, passes.number(), weigh);
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
  return lights_of_pass(
      {scene, world, *tracer, emitters}, walk_options(scene, world, options, warnings),
      options.pool, 0,
      [&](const VirtualLights& pool, std::size_t) { return weigh_by_flux(world, pool); });
}

}  // namespace lantern
