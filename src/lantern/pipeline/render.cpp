// SPDX-License-Identifier: MIT
#include "lantern/pipeline/render.h"

#include "lantern/core/error.h"
#include "lantern/image/accumulation.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/resample.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <numbers>

namespace lantern {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The scene made ready: everything that stays the same from pass to pass.
struct Stage {
  World world;
  std::unique_ptr<Tracer> tracer;
  Emitters emitters;

  explicit Stage(const Scene& scene)
      : world(make_world(scene)), tracer(make_embree_tracer(scene, world)), emitters(scene, world) {
    if (world.size() == 0) throw Error("the scene has no triangles");
  }
};

void require_light(const Emitters& emitters) {
  if (emitters.empty()) {
    throw Error(
        "the scene has no light: name materials that emit with --emitter 'PATTERN=R,G,B', or give "
        "--sky R,G,B");
  }
}

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
VirtualLights lights_of_pass(const Scene& scene, const Stage& stage, WalkOptions walk_with,
                             std::size_t pool, std::size_t pass) {
  walk_with.pass = pass;
  if (pool <= 1) return walk(scene, stage.world, *stage.tracer, stage.emitters, walk_with);
  std::size_t count = 0;
  for (const std::size_t n : make_survival(walk_with.paths, walk_with.reflectivity, 0).paths) {
    count += n;
  }
  const std::size_t paths = walk_with.paths;
  const double radius = static_cast<double>(stage.world.bounds.radius());
  const double disc = std::numbers::pi * radius * radius;
  walk_with.paths *= pool;
  VirtualLights lights = resample(
      walk(scene, stage.world, *stage.tracer, stage.emitters, walk_with), count, pass, disc);
  lights.paths = paths;
  return lights;
}

/// Turns finished tiles into reports of the share done and the time left.
class ProgressMeter {
 public:
  ProgressMeter(const RenderOptions& options, const ProgressReport& report, double elapsed)
      : options_(options),
        report_(report),
        elapsed_(elapsed),
        pixels_(static_cast<double>(options.width) * options.height) {}

  void tile_done(std::size_t pixels) {
    if (!report_) return;
    const std::lock_guard lock(mutex_);
    done_ += static_cast<double>(pixels) / pixels_;
    const double now = watch_.seconds();
    double share = 0.0, left = std::numeric_limits<double>::infinity();
    if (options_.passes > 0) {
      share = done_ / static_cast<double>(options_.passes);
      left = now * (1.0 / share - 1.0);
    }
    if (options_.seconds) {
      const double in_time = (elapsed_ + now) / *options_.seconds;
      share = std::min(1.0, std::max(share, in_time));
      left = std::min(left, std::max(0.0, *options_.seconds - elapsed_ - now));
    }
    report_({share, left, passes_done_});
  }
  void pass_done() {
    const std::lock_guard lock(mutex_);
    ++passes_done_;
  }

 private:
  const RenderOptions& options_;
  const ProgressReport& report_;
  double elapsed_;
  double pixels_;
  Stopwatch watch_;
  std::mutex mutex_;
  double done_ = 0.0;
  std::size_t passes_done_ = 0;
};

}  // namespace

Rendered render(const Scene& scene, const RenderOptions& options, const StopFlag& stop,
                const ProgressReport& report, double elapsed) {
  const Stopwatch total;
  Rendered result;
  RenderStatistics& statistics = result.statistics;
  const Stage stage(scene);
  if (!options.given_lights) require_light(stage.emitters);
  const WalkOptions walk_with = walk_options(scene, stage.world, options.lights, result.warnings);
  const Camera camera =
      choose_camera(scene, stage.world, *stage.tracer, options.camera,
                    static_cast<float>(options.width) / static_cast<float>(options.height));
  const GatherInput input{scene, stage.world, *stage.tracer, stage.emitters, camera};
  GatherOptions gather_with;
  gather_with.width = options.width;
  gather_with.height = options.height;
  gather_with.samples = options.samples;
  gather_with.bound = options.bound;
  gather_with.compensate = options.compensate;
  gather_with.seed = options.lights.points.seed;
  gather_with.shadow_rays = options.shadow_rays;
  statistics.seconds_prepare = total.seconds();

  ProgressMeter meter(options, report, elapsed);
  Accumulation sum(options.width, options.height);
  const Stopwatch passes_watch;
  for (std::size_t pass = 0; options.passes == 0 || pass < options.passes; ++pass) {
    if (options.seconds && pass > 0) {
      const double per_pass = passes_watch.seconds() / static_cast<double>(pass);
      if (elapsed + total.seconds() + per_pass > *options.seconds) break;
    }
    const Stopwatch lights_watch;
    VirtualLights walked;
    if (!options.given_lights) {
      walked = lights_of_pass(scene, stage, walk_with, options.lights.pool, pass);
    }
    const VirtualLights& lights = options.given_lights ? *options.given_lights : walked;
    statistics.seconds_lights += lights_watch.seconds();

    const Stopwatch gather_watch;
    gather_with.pass = pass;
    Image image = gather(input, lights, gather_with, statistics.rays, stop,
                         [&](std::size_t pixels) { meter.tile_done(pixels); });
    statistics.seconds_gather += gather_watch.seconds();
    const bool whole = !stop.load();
    if (!whole && pass > 0) break;
    statistics.lights += lights.size();
    statistics.paths += lights.paths;
    statistics.reflectivity = lights.reflectivity;
    ++statistics.passes;
    if (!whole || options.passes == 1) {
      result.image = std::move(image);
      return result;
    }
    sum.add(image);
    meter.pass_done();
  }
  result.image = sum.mean();
  return result;
}

VirtualLights make_lights(const Scene& scene, const LightOptions& options,
                          std::vector<std::string>& warnings) {
  const Stage stage(scene);
  require_light(stage.emitters);
  return lights_of_pass(scene, stage, walk_options(scene, stage.world, options, warnings),
                        options.pool, 0);
}

}  // namespace lantern
