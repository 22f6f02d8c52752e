// SPDX-License-Identifier: MIT
// A loaded scene to a picture by any of the methods. A method is a file render_*.cpp of its own;
// the options and statistics that only some methods know say so.
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/gather/gather.h"
#include "lantern/image/image.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/lights/walk.h"
#include "lantern/pipeline/camera.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/hemicube_rows.h"
#include "lantern/radiosity/patches.h"
#include "lantern/radiosity/solve.h"
#include "lantern/raster/shadow_method.h"
#include "lantern/raster/volume_method.h"
#include "lantern/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lantern {

enum class Method {
  kInstantRadiosity,      // [Keller 1997]
  kPath,                  // [Kajiya 1986]
  kRadiosityMatrix,       // [Goral et al. 1984]
  kRadiosityHemicube,     // [Cohen & Greenberg 1985]
  kRadiosityProgressive,  // [Cohen et al. 1988]
  kRadiosityGpu,          // [Coombe et al. 2004]
};

/// What gathers the lights (instant radiosity).
enum class Backend {
  kCpu,  // shadow rays
  kGl,   // OpenGL
};

/// How lights are made (instant radiosity).
struct LightOptions {
  std::size_t paths = 256;
  std::size_t pool = 1;               // walk so many times the paths and keep as many lights as
                                      // `paths` would leave, those that matter (see resample.h)
  std::optional<float> reflectivity;  // none: the scene's mean
  bool jitter = false;
  PointSet points;
};

/// How paths are traced (path).
struct PathTracing {
  std::uint64_t seed = 0;
  bool variance = false;  // the picture of the variance as well
};

/// How surfaces are cut into patches and light is exchanged between these (radiosity).
struct RadiosityOptions {
  PatchOptions patches;
  std::optional<int> refinements;  // rounds that place patches where light varies; none: 2 for
                                   // matrix and gpu, 0 for the others
  Solver solver = Solver::kGaussSeidel;  // matrix
  HemicubeOptions hemicube;
  double cutoff = 1e-4;  // progressive, gpu: the share of the flux emitted that may stay unshot
  bool ambient = true;   // progressive, gpu: what is unshot lights all surfaces alike
};

struct RenderOptions {
  Method method = Method::kInstantRadiosity;
  CameraChoice camera;
  int width = 512;
  int height = 512;
  int samples = 1;                // per pixel and pass
  std::size_t passes = 1;         // 0: until `seconds` or `stop` end it
  std::optional<double> seconds;  // no pass starts that is not expected to end by then

  // Instant radiosity.
  LightOptions lights;
  const VirtualLights* given_lights = nullptr;  // these, in every pass, instead of a walk
  float bound = 0.0f;
  bool compensate = false;
  ShadowRays shadow_rays = ShadowRays::kPackets;
  Backend backend = Backend::kCpu;
  int tile = 1;                                   // GL: so many pixels a side share the lights
  ShadowMethod shadows = ShadowMethod::kVolumes;  // GL
  bool deal_lights = false;  // GL: out among the samples of a pixel, see RasterOptions
  VolumeMethod volumes = VolumeMethod::kExact;  // GL
  std::optional<std::size_t> show_volumes;      // GL: those of this light, over the picture
  std::optional<int> gl_device;  // of those that `lantern info --gl` names; none: the first usable

  PathTracing path;
  RadiosityOptions radiosity;

  /// Told one line at a time, from any thread, what memory and time long work is going to take.
  std::function<void(const std::string&)> notice;
};

struct RayCounts {
  std::uint64_t camera_rays = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t compensation_rays = 0;
  std::uint64_t bounce_rays = 0;
};

/// What a method does not have is zero.
struct RadiosityStatistics {
  std::size_t patches = 0;
  std::size_t elements = 0;  // sides of patches that light can come to
  std::size_t hemicubes = 0;
  std::size_t rounds = 0;            // of refinement
  std::uint64_t bytes_expected = 0;  // of the last round's matrix, as told beforehand
  double seconds_matrix = 0.0;       // that it took
  double seconds_expected = 0.0;     // to assemble and solve it, likewise
  FormFactorCounts form_factors;
  RowSums row_sums;
  double reciprocity_error = 0.0;
  int sweeps = 0;  // of Gauss-Seidel
  std::size_t shots = 0;
  double unshot_share = 0.0;        // of the flux emitted
  double conservation_error = 0.0;  // likewise
};

/// What a method does not have is zero.
struct RenderStatistics {
  std::size_t lights = 0;  // of all passes together, like the counts below
  std::size_t paths = 0;
  std::size_t passes = 0;
  float reflectivity = 0.0f;
  RayCounts rays;
  RadiosityStatistics radiosity;
  double seconds_prepare = 0.0;  // world, tree, emitters
  double seconds_lights = 0.0;
  double seconds_gather = 0.0;
  std::map<std::string, double> seconds_gpu;  // GL: of each stage; empty without timers
};

struct Rendered {
  Image image;
  std::optional<Image> variance;  // of each pixel and channel of `image`, where it was asked for
  RenderStatistics statistics;
  std::vector<std::string> warnings;
};

struct Progress {
  double share = 0.0;         // of the work, in [0, 1]
  double seconds_left = 0.0;  // expected
  std::size_t passes_done = 0;
  const char* pass = "pass";  // what is counted
};
/// Called from any thread, one call at a time.
using ProgressReport = std::function<void(const Progress&)>;

/// Throws Error if the scene has no triangles or no light. `seconds` counts from `elapsed` seconds
/// before the call. Stopped in its first pass the picture is black where nothing was done yet;
/// later passes count whole or not at all.
Rendered render(const Scene& scene, const RenderOptions& options, const StopFlag& stop,
                const ProgressReport& report = {}, double elapsed = 0.0);

}  // namespace lantern
