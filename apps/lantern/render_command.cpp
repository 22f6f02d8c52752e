// SPDX-License-Identifier: MIT
#include "lantern/core/file.h"
#include "lantern/core/version.h"
#include "lantern/image/write.h"
#include "lantern/lights/export.h"

#include "apps/lantern/commands.h"
#include "apps/lantern/methods.h"
#include "apps/lantern/options.h"
#include "apps/lantern/terminal.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <sys/resource.h>

namespace lantern::app {
namespace {

constexpr std::size_t kUsualPaths = 256;
constexpr std::size_t kUsualPathsInTime = 32;  // small passes, so that the time is kept

struct Arguments {
  SceneArguments scene;
  LightArguments lights;
  std::string out;
  std::string size = "512x512";
  std::size_t passes = 0;  // 0: not given
  double seconds = 0.0;    // 0: not given
  int samples = 0;         // 0: not given
  std::string method = "instant-radiosity";
  std::string backend = "cpu";
  std::string shadows = "stencil";
  int tile = 4;
  bool deal_lights = false;
  std::string volumes = "exact";
  std::optional<std::size_t> show_volumes;
  int gl_device = -1;
  CameraArguments camera;
  std::optional<float> bound;
  bool compensate = false;
  float exposure = 0.0f;
  std::string tone = "plain";
  std::string depth = "half";
  std::string lights_from;
  bool single_rays = false;
  std::string variance;
  RadiosityOptions radiosity;
  std::string solver = "gauss-seidel";
  bool no_ambient = false;
  bool json = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr std::uint64_t kKibibyte = 1024;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * kKibibyte;
}

/// What several methods share; samples and passes are those given, or 0.
RenderOptions common_options(const Arguments& arguments) {
  RenderOptions options;
  options.method = method_of(arguments.method);
  std::tie(options.width, options.height) = parse_size(arguments.size);
  options.camera = arguments.camera.choice();
  options.passes = arguments.passes;
  options.samples = arguments.samples;
  if (arguments.seconds > 0.0) options.seconds = arguments.seconds;
  options.backend = arguments.backend == "gl" ? Backend::kGl : Backend::kCpu;
  if (arguments.gl_device >= 0) options.gl_device = arguments.gl_device;
  return options;
}

void add_instant_radiosity(const Arguments& arguments, RenderOptions& options) {
  const bool in_time = options.seconds.has_value();
  if (options.passes == 0 && !in_time) options.passes = 1;
  // A single pass is Keller's walk; several gain from choosing among many more lights.
  constexpr std::size_t kPoolOfSeveralPasses = 16;
  options.lights = arguments.lights.options(in_time ? kUsualPathsInTime : kUsualPaths,
                                            options.passes == 1 ? 1 : kPoolOfSeveralPasses);
  // Several passes have a sample each; a single one must smooth its edges by itself.
  constexpr int kSamplesOfSinglePass = 4;
  if (options.samples == 0) options.samples = options.passes == 1 ? kSamplesOfSinglePass : 1;
  // What is compensated may be cut early; what is not must not be missed.
  constexpr float kUsualBound = 20.0f, kUsualBoundCompensated = 5.0f;
  options.bound =
      arguments.bound.value_or(arguments.compensate ? kUsualBoundCompensated : kUsualBound);
  options.compensate = arguments.compensate;
  options.shadow_rays = arguments.single_rays ? ShadowRays::kSingle : ShadowRays::kPackets;
  if (arguments.shadows == "interleaved") {
    options.tile = arguments.tile;
    options.shadows = ShadowMethod::kCheaper;
  }
  if (arguments.shadows == "maps") options.shadows = ShadowMethod::kMaps;
  options.volumes = arguments.volumes == "z-pass"   ? VolumeMethod::kZPass
                    : arguments.volumes == "z-fail" ? VolumeMethod::kZFail
                                                    : VolumeMethod::kExact;
  options.show_volumes = arguments.show_volumes;
  options.deal_lights = arguments.deal_lights;
}

void add_path(const Arguments& arguments, RenderOptions& options) {
  const bool in_time = options.seconds.has_value();
  if (options.passes == 0 && !in_time) options.passes = 1;
  constexpr int kUsualSamples = 64;
  if (options.samples == 0) options.samples = in_time ? kPathSamplesInTime : kUsualSamples;
  options.path.seed = arguments.lights.seed;
  options.path.variance = !arguments.variance.empty();
}

void add_radiosity(const Arguments& arguments, RenderOptions& options) {
  // A solution is one pass; its samples smooth the edges.
  constexpr int kUsualSamples = 16;
  if (options.passes > 1) {
    throw UsageError(fmt::format("--passes means nothing to --method {}", arguments.method));
  }
  if (arguments.radiosity.hemicube.resolution % Hemicube::kResolutionStep != 0) {
    throw UsageError(
        fmt::format("--hemicube takes a multiple of {}", int{Hemicube::kResolutionStep}));
  }
  options.passes = 1;
  if (options.samples == 0) options.samples = kUsualSamples;
  options.radiosity = arguments.radiosity;
  options.radiosity.hemicube.seed = arguments.lights.seed;
  options.radiosity.ambient = !arguments.no_ambient;
  options.radiosity.solver =
      arguments.solver == "elimination" ? Solver::kElimination : Solver::kGaussSeidel;
  if (!arguments.scene.quiet) options.notice = note;
}

RenderOptions render_options(const Arguments& arguments) {
  RenderOptions options = common_options(arguments);
  switch (options.method) {
    case Method::kInstantRadiosity:
      add_instant_radiosity(arguments, options);
      break;
    case Method::kPath:
      add_path(arguments, options);
      break;
    case Method::kRadiosityMatrix:
    case Method::kRadiosityHemicube:
    case Method::kRadiosityProgressive:
    case Method::kRadiosityGpu:
      add_radiosity(arguments, options);
      break;
  }
  return options;
}

void add_instant_radiosity(const Arguments& arguments, const RenderOptions& options,
                           const RenderStatistics& statistics, Metadata& metadata) {
  metadata.insert({{"lights", std::to_string(options.lights.paths)},
                   {"pool", std::to_string(options.lights.pool)},
                   {"reflectivity", fmt::format("{}", statistics.reflectivity)},
                   {"bound", fmt::format("{}", options.bound)},
                   {"compensate", options.compensate ? "yes" : "no"},
                   {"sampler", arguments.lights.sampler},
                   {"jitter", arguments.lights.jitter ? "yes" : "no"},
                   {"backend", arguments.backend}});
  if (options.backend == Backend::kGl) metadata["shadows"] = arguments.shadows;
  if (options.tile > 1) metadata["tile"] = std::to_string(options.tile);
  if (options.deal_lights) metadata["deal-lights"] = "yes";
  if (options.volumes != VolumeMethod::kExact) metadata["volumes"] = arguments.volumes;
  if (options.show_volumes) metadata["show-volumes"] = std::to_string(*options.show_volumes);
  if (!arguments.lights_from.empty()) metadata["lights-from"] = arguments.lights_from;
}

/// Whether it sends out flux shot by shot, as against solving a matrix.
bool shoots(Method method) {
  return method == Method::kRadiosityProgressive || method == Method::kRadiosityGpu;
}

void add_radiosity(const RenderOptions& options, const RenderStatistics& statistics,
                   Metadata& metadata) {
  const RadiosityOptions& radiosity = options.radiosity;
  metadata["patches"] = std::to_string(statistics.radiosity.patches);
  metadata["refine"] = std::to_string(statistics.radiosity.rounds);
  if (options.method == Method::kRadiosityMatrix) {
    metadata["solver"] = radiosity.solver == Solver::kElimination ? "elimination" : "gauss-seidel";
    return;
  }
  metadata["hemicube"] = std::to_string(radiosity.hemicube.resolution);
  if (options.backend == Backend::kGl) metadata["backend"] = "gl";
  if (shoots(options.method)) {
    metadata.insert({{"cutoff", fmt::format("{}", radiosity.cutoff)},
                     {"shots", std::to_string(statistics.radiosity.shots)},
                     {"unshot", fmt::format("{:.3g}", statistics.radiosity.unshot_share)},
                     {"ambient", radiosity.ambient ? "yes" : "no"}});
  }
}

Metadata metadata_of(const Arguments& arguments, const RenderOptions& options,
                     const RenderStatistics& statistics) {
  Metadata metadata = {{"software", std::string("lantern ") + kVersion},
                       {"scene", arguments.scene.path.filename().string()},
                       {"method", arguments.method},
                       {"passes", std::to_string(statistics.passes)},
                       {"samples", std::to_string(options.samples)},
                       {"seed", std::to_string(arguments.lights.seed)}};
  // What is not given has its usual value.
  const auto add_given = [&](const char* key, const std::string& value) {
    if (!value.empty()) metadata[key] = value;
  };
  const CameraArguments& camera = arguments.camera;
  add_given("camera", camera.name);
  add_given("look-at", camera.look_at);
  add_given("fov", camera.fov > 0.0f ? fmt::format("{}", camera.fov) : "");
  add_given("time", arguments.seconds > 0.0 ? fmt::format("{}", arguments.seconds) : "");
  add_given("sky", arguments.scene.sky);
  add_given("emitter", fmt::format("{}", fmt::join(arguments.scene.emitters, " ")));
  add_given("exposure", fmt::format("{}", arguments.exposure));
  add_given("tone", arguments.tone);
  switch (options.method) {
    case Method::kInstantRadiosity:
      add_instant_radiosity(arguments, options, statistics, metadata);
      break;
    case Method::kPath:
      break;
    case Method::kRadiosityMatrix:
    case Method::kRadiosityHemicube:
    case Method::kRadiosityProgressive:
    case Method::kRadiosityGpu:
      add_radiosity(options, statistics, metadata);
      break;
  }
  return metadata;
}

nlohmann::json radiosity_json(Method method, const RadiosityStatistics& s) {
  nlohmann::json out = {{"patches", s.patches}, {"elements", s.elements}, {"rounds", s.rounds}};
  if (method == Method::kRadiosityMatrix) {
    out["form_factor_rays"] = s.form_factors.rays;
    out["open_pairs"] = s.form_factors.open_pairs;
    out["screened_pairs"] = s.form_factors.screened_pairs;
    out["bytes_expected"] = s.bytes_expected;
    out["seconds_matrix"] = s.seconds_matrix;
    out["seconds_expected"] = s.seconds_expected;
  } else {
    out["hemicubes"] = s.hemicubes;
  }
  if (shoots(method)) {
    out["shots"] = s.shots;
    out["unshot_share"] = s.unshot_share;
    out["conservation_error"] = s.conservation_error;
  } else {
    out["row_sums"] = {s.row_sums.least, s.row_sums.mean, s.row_sums.most};
    out["reciprocity_error"] = s.reciprocity_error;
    out["sweeps"] = s.sweeps;
  }
  return out;
}

void print_json(Method method, const Rendered& rendered, double seconds_load,
                double seconds_total) {
  const RenderStatistics& s = rendered.statistics;
  nlohmann::json out = {{"lights", s.lights},
                        {"paths", s.paths},
                        {"passes", s.passes},
                        {"reflectivity", s.reflectivity},
                        {"camera_rays", s.rays.camera_rays},
                        {"shadow_rays", s.rays.shadow_rays},
                        {"compensation_rays", s.rays.compensation_rays},
                        {"bounce_rays", s.rays.bounce_rays},
                        {"seconds_load", seconds_load},
                        {"seconds_prepare", s.seconds_prepare},
                        {"seconds_lights", s.seconds_lights},
                        {"seconds_gather", s.seconds_gather},
                        {"seconds_total", seconds_total},
                        {"peak_bytes", peak_bytes()},
                        {"warnings", rendered.warnings}};
  if (!s.seconds_gpu.empty()) out["seconds_gpu"] = s.seconds_gpu;
  if (s.radiosity.patches > 0) out.update(radiosity_json(method, s.radiosity));
  fmt::print("{}\n", out.dump());
}

/// Variances are small numbers of many magnitudes.
void require_variance_format(const Arguments& arguments) {
  require_image_format(arguments.variance);
  if (extension(arguments.variance) == ".png") {
    throw UsageError(
        fmt::format("--variance: '{}' should be .exr, .hdr or .pfm; PNG has too few "
                    "steps for variances",
                    arguments.variance));
  }
  if (arguments.variance == arguments.out) {
    throw UsageError("--variance and --output name the same file");
  }
}

/// What means nothing to shadow rays or to GL is wrong usage there.
void check_backend(const CLI::App& command, const Arguments& arguments) {
  const bool gl = arguments.backend == "gl";
  const Method method = method_of(arguments.method);
  if (gl && method != Method::kInstantRadiosity && method != Method::kRadiosityHemicube) {
    throw UsageError(fmt::format("--backend gl means nothing to --method {}", arguments.method));
  }
  const std::vector<const char*> of_other =
      gl ? std::vector{"--compensate", "--single-rays"}
         : std::vector{"--shadows", "--tile",         "--deal-lights",
                       "--volumes", "--show-volumes", "--gl-device"};
  if (arguments.shadows != "interleaved" && command.count("--tile") > 0) {
    throw UsageError("--tile takes --shadows interleaved");
  }
  for (const char* option : {"--volumes", "--show-volumes"}) {
    if (arguments.shadows != "maps" || command.count(option) == 0) continue;
    throw UsageError(fmt::format("{} means nothing to --shadows maps", option));
  }
  for (const char* option : of_other) {
    if (command.count(option) == 0) continue;
    throw UsageError(fmt::format("{} means nothing to --backend {}", option, arguments.backend));
  }
}

void run(const CLI::App& command, Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  refuse_options_of_others(command, arguments.method);
  check_backend(command, arguments);
  arguments.scene.check();
  RenderOptions options = render_options(arguments);
  check_format(arguments.out, require_image_format);
  require_other_file(arguments.out, arguments.scene.path);
  require_other_file(arguments.out, arguments.lights_from);
  require_writable(arguments.out);
  if (!arguments.variance.empty()) {
    require_variance_format(arguments);
    require_writable(arguments.variance);
  }
  ThreadScope threads(arguments.scene.threads);
  threads.run([&] {
    const StopFlag& stop = stop_on_interrupt();
    const Loaded loaded = arguments.scene.load_scene_now();
    std::optional<VirtualLights> given;
    if (!arguments.lights_from.empty()) {
      given = read_lights(arguments.lights_from, loaded.scene.origin);
      options.given_lights = &*given;
    }
    const double seconds_load = seconds_since(start);

    Rendered rendered;
    {
      ProgressBar bar(arguments.scene.quiet);
      rendered = render(
          loaded.scene, options, stop, [&](const Progress& p) { bar.show(p); }, seconds_load);
    }
    if (!arguments.scene.quiet) {
      for (const std::string& warning : rendered.warnings) warn(warning);
      if (stop.load()) warn(fmt::format("stopped early; {} has what was done", arguments.out));
    }
    WriteOptions write_with;
    write_with.exr_depth = arguments.depth == "float" ? ExrDepth::kFloat : ExrDepth::kHalf;
    write_with.tone.exposure = arguments.exposure;
    write_with.tone.curve = arguments.tone == "filmic" ? ToneCurve::kFilmic : ToneCurve::kPlain;
    write_with.metadata = metadata_of(arguments, options, rendered.statistics);
    finish_in_peace();
    write_image(arguments.out, rendered.image, write_with);
    if (rendered.variance) {
      write_with.exr_depth = ExrDepth::kFloat;  // half has no numbers below 6e-8
      write_with.metadata["quantity"] = "variance of each pixel's mean";
      write_image(arguments.variance, *rendered.variance, write_with);
    }
    if (arguments.json) {
      print_json(options.method, rendered, seconds_load, seconds_since(start));
    }
  });
}

}  // namespace

void add_render(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  Arguments& a = *arguments;
  CLI::App* command = app.add_subcommand("render", "Turn a scene into a picture");
  a.scene.add_to(*command);
  a.lights.add_to(*command);
  command->add_option("-o,--output", a.out, "OUT.exr, OUT.png, OUT.hdr or OUT.pfm")->required();
  command->add_option("--size", a.size, "WxH in pixels")->capture_default_str();
  command->add_option("--passes", a.passes, "Passes, each with lights of its own (1)")
      ->check(CLI::Range(1, 1'000'000'000));
  command->add_option("--time", a.seconds, "Stop after so many seconds")->check(finite(1e-3, 1e9));
  command
      ->add_option("--samples", a.samples, "Samples per pixel and pass (4; with several passes 1)")
      ->check(CLI::Range(1, 65536));
  command->add_option("--method", a.method, "How the picture is made")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command->add_option("--backend", a.backend, "cpu or gl (instant-radiosity, radiosity-hemicube)")
      ->check(CLI::IsMember({"cpu", "gl"}))
      ->capture_default_str();
  command
      ->add_option(
          "--shadows", a.shadows,
          "How --backend gl finds shadows: stencil, interleaved (by volumes or maps), maps")
      ->check(CLI::IsMember({"stencil", "interleaved", "maps"}))
      ->capture_default_str();
  command->add_option("--tile", a.tile, "Pixels a side that share the lights, if interleaved")
      ->check(CLI::IsMember({2, 4, 8}))
      ->capture_default_str();
  command->add_flag(
      "--deal-lights", a.deal_lights,
      "Deal the lights out among the samples of a pixel (gl): smooth edges for little");
  command
      ->add_option("--volumes", a.volumes,
                   "How shadow volumes are counted: exact; z-pass, z-fail: the classics, for study")
      ->check(CLI::IsMember({"exact", "z-pass", "z-fail"}))
      ->capture_default_str();
  command->add_option("--show-volumes", a.show_volumes,
                      "Draw the shadow volumes of this light over the picture (0: the first)");
  command->add_option("--gl-device", a.gl_device, "A device of `lantern info --gl`, by its number")
      ->check(CLI::Range(0, 1'000'000));
  a.camera.add_to(*command);
  command
      ->add_option(
          "--bound", a.bound,
          "Bound on the geometry term in 1/(bounding radius)^2, 0 for none (20; compensated 5)")
      ->check(finite(0.0, 1e30));
  command->add_flag("--compensate", a.compensate, "Give back what the bound takes, by tracing");
  command->add_option("--exposure", a.exposure, "Stops, for PNG")->check(finite(-100.0, 100.0));
  command->add_option("--tone", a.tone, "plain or filmic, for PNG")
      ->check(CLI::IsMember({"plain", "filmic"}))
      ->capture_default_str();
  command->add_option("--depth", a.depth, "half or float, for EXR")
      ->check(CLI::IsMember({"half", "float"}))
      ->capture_default_str();
  command->add_option("--lights-from", a.lights_from, "Lights of a JSON file instead of a walk");
  command->add_flag("--single-rays", a.single_rays, "Shadow rays one by one, for checks");
  command->add_option("--variance", a.variance,
                      "OUT.exr, OUT.hdr or OUT.pfm: the variance of each pixel's mean (path)");
  CLI::Option* count =
      command->add_option("--patches", a.radiosity.patches.count, "Patches at most (radiosity)")
          ->check(CLI::Range(1, 16'000'000))
          ->capture_default_str();
  command
      ->add_option("--refine", a.radiosity.refinements,
                   "Rounds that place patches where light varies (2; hemicube, progressive 0)")
      ->check(CLI::Range(0, 16));
  command->add_option("--solver", a.solver, "gauss-seidel or elimination (matrix)")
      ->check(CLI::IsMember({"gauss-seidel", "elimination"}))
      ->capture_default_str();
  command->add_option("--patch-size", a.radiosity.patches.size, "Their longest edge in metres")
      ->check(finite(1e-9, 1e9))
      ->excludes(count);
  command
      ->add_option("--hemicube", a.radiosity.hemicube.resolution,
                   "Pixels along a hemicube's edge, a multiple of 8")
      ->check(CLI::Range(Hemicube::kResolutionStep, 4096))
      ->capture_default_str();
  command
      ->add_option("--cutoff", a.radiosity.cutoff,
                   "Stop shooting when this share of the flux is left")
      ->check(finite(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--no-ambient", a.no_ambient, "Leave out what is not shot yet");
  command->add_flag("--json", a.json, "Statistics as one JSON object on standard output");
  command->callback([command, arguments] { run(*command, *arguments); });
}

}  // namespace lantern::app
