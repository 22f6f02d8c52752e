// SPDX-License-Identifier: MIT
// All methods on one scene: the mean irradiance of what a camera sees of each surface, as the path
// tracer has it and by how much each other method differs from that. Path tracing and instant
// radiosity run several times with other random numbers, whose scatter tells their noise.
#include "lantern/image/compare.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/camera.h"
#include "lantern/pipeline/render.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/eye.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace {

using namespace lantern;

/// One plane of one material: normal and distance from the origin in steps that tell planes apart.
using Plane = std::tuple<std::uint32_t, int, int, int, int>;

/// The pixels that show one surface alone, and how much of it each shows.
struct Surface {
  std::string name;
  Rgb reflectance{0.0f};
  std::vector<std::size_t> pixels;
  std::vector<double> areas;
};

std::string name_of(const Scene& scene, MaterialId material, const Vec3& normal, float distance) {
  constexpr float kAlong = 0.99f;
  const char* names[3][2] = {{"+x", "-x"}, {"+y", "-y"}, {"+z", "-z"}};
  std::string facing = fmt::format("({:.1f} {:.1f} {:.1f})", normal.x, normal.y, normal.z);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(normal[axis]) > kAlong) facing = names[axis][normal[axis] < 0.0f ? 1 : 0];
  }
  return fmt::format("{} {} {:.2f} m", scene.materials[index(material)].name, facing, distance);
}

class Seen {
 public:
  Seen(const Scene& scene, const CameraChoice& choice, int size)
      : scene_(scene),
        world_(make_world(scene)),
        tracer_(make_embree_tracer(scene, world_)),
        eye_(choose_camera(scene, world_, *tracer_, choice, 1.0f), size, size),
        size_(size) {}

  /// What is seen by the centre and all four corners of a pixel counts: nothing else is mixed in.
  std::vector<Surface> surfaces() const {
    std::map<Plane, Surface> found;
    for (int y = 0; y < size_; ++y) {
      for (int x = 0; x < size_; ++x) add(x, y, found);
    }
    std::vector<Surface> surfaces;
    // A surface of fewer pixels is a sliver: its mean is mostly its border.
    constexpr std::size_t kFewest = 100;
    for (auto& [plane, surface] : found) {
      if (surface.pixels.size() >= kFewest) surfaces.push_back(std::move(surface));
    }
    return surfaces;
  }

 private:
  struct View {
    Plane plane;
    Vec3 normal;
    float distance;  // of the plane from the origin
    SurfacePoint point;
    Vec3 direction;
    float way;
  };

  std::optional<View> view(float x, float y) const {
    Ray ray;
    ray.origin = eye_.origin();
    ray.direction = glm::normalize(eye_.direction(x, y));
    const Hit hit = tracer_->closest(ray);
    if (!hit) return std::nullopt;
    View view;
    view.point = surface_at(scene_, world_, hit.triangle, hit.uv);
    const bool front = glm::dot(view.point.geometric_normal, ray.direction) < 0.0f;
    const Rgb emission = emission_at(scene_, world_, hit.triangle, hit.uv, front);
    if (is_black(view.point.reflectance) || !is_black(emission)) return std::nullopt;
    view.normal = front ? view.point.geometric_normal : -view.point.geometric_normal;
    view.distance = glm::dot(view.normal, view.point.position);
    constexpr float kNormals = 16.0f, kDistances = 256.0f;
    const auto step = [](float value, float steps) {
      return static_cast<int>(std::lround(value * steps));
    };
    view.plane = {static_cast<std::uint32_t>(world_.materials[hit.triangle]),
                  step(view.normal.x, kNormals), step(view.normal.y, kNormals),
                  step(view.normal.z, kNormals),
                  step(view.distance / world_.coordinate_scale(), kDistances)};
    view.direction = ray.direction;
    view.way = hit.distance;
    return view;
  }

  void add(int x, int y, std::map<Plane, Surface>& found) const {
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
    const std::optional<View> centre = view(fx + 0.5f, fy + 0.5f);
    if (!centre) return;
    for (const Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
      const std::optional<View> there = view(fx + corner.x, fy + corner.y);
      if (!there || there->plane != centre->plane) return;
    }
    Surface& surface = found[centre->plane];
    surface.name = name_of(scene_, static_cast<MaterialId>(std::get<0>(centre->plane)),
                           centre->normal, centre->distance);
    surface.reflectance = centre->point.reflectance;
    surface.pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) +
                             static_cast<std::size_t>(x));
    // A pixel of the plane at a unit's distance, whose solid angle falls with the cube of the
    // cosine to its axis.
    const Vec3 axis = glm::normalize(
        eye_.direction(0.5f * static_cast<float>(size_), 0.5f * static_cast<float>(size_)));
    const float cosine = glm::dot(centre->direction, axis);
    surface.areas.push_back(
        static_cast<double>(cosine * cosine * cosine * centre->way * centre->way /
                            -glm::dot(centre->direction, centre->normal)));
  }

  const Scene& scene_;
  World world_;
  std::unique_ptr<Tracer> tracer_;
  Eye eye_;
  int size_;
};

/// In W/m², the mean of the channels over the area seen.
double mean_irradiance(const Surface& surface, const Image& image) {
  double sum = 0.0, area = 0.0;
  for (std::size_t p = 0; p < surface.pixels.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      if (surface.reflectance[c] == 0.0f) continue;
      sum +=
          surface.areas[p] *
          static_cast<double>(image.pixels[surface.pixels[p]][c] * kPi / surface.reflectance[c]) /
          3.0;
    }
    area += surface.areas[p];
  }
  return sum / area;
}

struct Candidate {
  const char* name;
  Method method;
};
constexpr Candidate kCandidates[] = {{"path", Method::kPath},
                                     {"instant-radiosity", Method::kInstantRadiosity},
                                     {"radiosity-matrix", Method::kRadiosityMatrix},
                                     {"radiosity-hemicube", Method::kRadiosityHemicube},
                                     {"radiosity-progressive", Method::kRadiosityProgressive},
                                     {"radiosity-gpu", Method::kRadiosityGpu}};

/// The mean of a method's pictures and of each surface in them, with its standard error.
struct Result {
  const char* name;
  Image image;
  std::vector<double> means, errors;
  double seconds = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Agreement of all methods, surface by surface");
  std::string path;
  RenderOptions options;
  int size = 256, runs = 8, path_samples = 128, light_passes = 64, samples = 16;
  options.radiosity.refinements = 2;
  std::vector<float> look_at;
  std::vector<std::string> only;
  app.add_option("scene", path)->required();
  app.add_option("--size", size, "Pixels along a side")->capture_default_str();
  app.add_option("--look-at", look_at, "Eye and target, six numbers")->delimiter(',')->expected(6);
  app.add_option("--methods", only, "Beside path; all")->delimiter(',');
  app.add_option("--runs", runs, "Of path and of instant radiosity")->capture_default_str();
  app.add_option("--path-samples", path_samples, "Of a run")->capture_default_str();
  app.add_option("--light-passes", light_passes, "Of a run")->capture_default_str();
  app.add_option("--patches", options.radiosity.patches.count)->capture_default_str();
  app.add_option("--hemicube", options.radiosity.hemicube.resolution)->capture_default_str();
  app.add_option("--cutoff", options.radiosity.cutoff)->capture_default_str();
  app.add_option("--refine", options.radiosity.refinements, "2");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!look_at.empty()) {
      options.camera.eye = Vec3(look_at[0], look_at[1], look_at[2]);
      options.camera.target = Vec3(look_at[3], look_at[4], look_at[5]);
    }
    const Loaded loaded = load_scene(path);
    const std::vector<Surface> surfaces = Seen(loaded.scene, options.camera, size).surfaces();
    options.width = options.height = size;
    options.lights.paths = 32;
    options.lights.pool = 16;
    options.bound = 5.0f;
    options.compensate = true;
    const StopFlag never{false};
    std::vector<Result> results;
    for (const Candidate& candidate : kCandidates) {
      options.method = candidate.method;
      const bool is_path = candidate.method == Method::kPath;
      const bool is_instant = candidate.method == Method::kInstantRadiosity;
      if (!is_path && !only.empty() &&
          std::find(only.begin(), only.end(), candidate.name) == only.end()) {
        continue;
      }
      options.samples = is_path ? path_samples : is_instant ? 1 : samples;
      options.passes = is_instant ? static_cast<std::size_t>(light_passes) : 1;
      Result& result = results.emplace_back();
      result.name = candidate.name;
      result.image = Image(size, size);
      const int count = is_path || is_instant ? runs : 1;
      std::vector<double> squares(surfaces.size(), 0.0);
      result.means.assign(surfaces.size(), 0.0);
      const auto start = std::chrono::steady_clock::now();
      for (int run = 0; run < count; ++run) {
        options.path.seed = options.lights.points.seed = static_cast<std::uint64_t>(run);
        const Image image = render(loaded.scene, options, never).image;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          result.image.pixels[i] += image.pixels[i] / static_cast<float>(count);
        }
        for (std::size_t s = 0; s < surfaces.size(); ++s) {
          const double mean = mean_irradiance(surfaces[s], image);
          result.means[s] += mean / count;
          squares[s] += mean * mean / count;
        }
      }
      result.seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const double variance = std::max(0.0, squares[s] - result.means[s] * result.means[s]);
        result.errors.push_back(count > 1 ? std::sqrt(variance / (count - 1)) : 0.0);
      }
    }
    const Result& judge = results.front();
    fmt::print("| surface | pixels | path, W/m2 |");
    for (std::size_t m = 1; m < results.size(); ++m) fmt::print(" {} |", results[m].name);
    fmt::print("\n|---|---|---|");
    for (std::size_t m = 1; m < results.size(); ++m) fmt::print("---|");
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const double expected = judge.means[s];
      fmt::print("\n| {} | {} | {:.4g} ± {:.2f} % |", surfaces[s].name, surfaces[s].pixels.size(),
                 expected, 100.0 * judge.errors[s] / expected);
      for (std::size_t m = 1; m < results.size(); ++m) {
        fmt::print(" {:+.2f}", 100.0 * (results[m].means[s] / expected - 1.0));
        if (results[m].errors[s] > 0.0) {
          fmt::print(" ± {:.2f}", 100.0 * results[m].errors[s] / expected);
        }
        fmt::print(" % |");
      }
    }
    fmt::print("\n| relmse of the picture | | |");
    for (std::size_t m = 1; m < results.size(); ++m) {
      fmt::print(" {:.2e} |", compare(results[m].image, judge.image).relmse);
    }
    fmt::print("\n| seconds | | {:.0f} |", judge.seconds);
    for (std::size_t m = 1; m < results.size(); ++m) fmt::print(" {:.0f} |", results[m].seconds);
    fmt::print("\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "agreement: {}\n", e.what());
    return 1;
  }
}
