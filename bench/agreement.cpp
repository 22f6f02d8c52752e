// SPDX-License-Identifier: MIT
// All methods on one scene: the mean irradiance of each surface that the camera sees, as the path
// tracer has it and by how much each other method differs from that.
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
#include <map>
#include <vector>

namespace {

using namespace lantern;

/// The pixels that show one surface alone: triangles of one material that face one way.
struct Surface {
  std::string name;
  Rgb reflectance{0.0f};
  std::vector<std::size_t> pixels;
};

const char* facing(const Vec3& normal) {
  constexpr float kAlong = 0.99f;
  const char* names[3][2] = {{"+x", "-x"}, {"+y", "-y"}, {"+z", "-z"}};
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(normal[axis]) > kAlong) return names[axis][normal[axis] < 0.0f ? 1 : 0];
  }
  return "slanted";
}

/// What is seen by all four corners of a pixel counts: nothing else is mixed in.
std::vector<Surface> surfaces_of(const Scene& scene, const CameraChoice& choice, int size) {
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Camera camera = choose_camera(scene, world, *tracer, choice, 1.0f);
  const Eye eye(camera, size, size);
  const auto surface_at_corner = [&](int x, int y) -> std::pair<std::string, Rgb> {
    Ray ray;
    ray.origin = eye.origin();
    ray.direction = eye.direction(static_cast<float>(x), static_cast<float>(y));
    const Hit hit = tracer->closest(ray);
    if (!hit) return {"", Rgb(0.0f)};
    const SurfacePoint point = surface_at(scene, world, hit.triangle, hit.uv);
    const bool front = glm::dot(point.geometric_normal, ray.direction) < 0.0f;
    const Rgb emission = emission_at(scene, world, hit.triangle, hit.uv, front);
    if (is_black(point.reflectance) || !is_black(emission)) return {"", Rgb(0.0f)};
    return {fmt::format("{} {}", scene.materials[index(world.materials[hit.triangle])].name,
                        facing(front ? point.geometric_normal : -point.geometric_normal)),
            point.reflectance};
  };
  std::map<std::string, Surface> found;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const auto [name, reflectance] = surface_at_corner(x, y);
      if (name.empty() || surface_at_corner(x + 1, y).first != name ||
          surface_at_corner(x, y + 1).first != name ||
          surface_at_corner(x + 1, y + 1).first != name) {
        continue;
      }
      Surface& surface = found[name];
      surface.name = name;
      surface.reflectance = reflectance;
      surface.pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                               static_cast<std::size_t>(x));
    }
  }
  std::vector<Surface> surfaces;
  // A surface of fewer pixels is a sliver: its mean is mostly its border.
  constexpr std::size_t kFewest = 100;
  for (auto& [name, surface] : found) {
    if (surface.pixels.size() >= kFewest) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

/// In W/m², the mean of the channels that the surface reflects.
double mean_irradiance(const Surface& surface, const Image& image) {
  double sum = 0.0;
  for (const std::size_t i : surface.pixels) {
    for (int c = 0; c < 3; ++c) {
      if (surface.reflectance[c] == 0.0f) continue;
      sum += static_cast<double>(image.pixels[i][c] * kPi / surface.reflectance[c]) / 3.0;
    }
  }
  return sum / static_cast<double>(surface.pixels.size());
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Agreement of all methods, surface by surface");
  std::string path;
  RenderOptions options;
  int size = 256, path_samples = 1024, light_passes = 256, samples = 16;
  app.add_option("scene", path)->required();
  app.add_option("--size", size, "Pixels along a side")->capture_default_str();
  app.add_option("--patches", options.radiosity.patches.count)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const Loaded loaded = load_scene(path);
    const std::vector<Surface> surfaces = surfaces_of(loaded.scene, options.camera, size);
    options.width = options.height = size;
    options.lights.paths = 32;
    options.lights.pool = 16;
    options.bound = 5.0f;
    options.compensate = true;
    const StopFlag never{false};
    std::vector<Image> images;
    std::vector<double> seconds;
    for (const Candidate& candidate : kCandidates) {
      options.method = candidate.method;
      options.samples = candidate.method == Method::kPath               ? path_samples
                        : candidate.method == Method::kInstantRadiosity ? 1
                                                                        : samples;
      options.passes = candidate.method == Method::kInstantRadiosity
                           ? static_cast<std::size_t>(light_passes)
                           : 1;
      const auto start = std::chrono::steady_clock::now();
      images.push_back(render(loaded.scene, options, never).image);
      seconds.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    fmt::print("| surface | pixels | path, W/m2 |");
    for (std::size_t m = 1; m < images.size(); ++m) fmt::print(" {} |", kCandidates[m].name);
    fmt::print("\n|---|---|---|");
    for (std::size_t m = 1; m < images.size(); ++m) fmt::print("---|");
    for (const Surface& surface : surfaces) {
      const double judge = mean_irradiance(surface, images[0]);
      fmt::print("\n| {} | {} | {:.4g} |", surface.name, surface.pixels.size(), judge);
      for (std::size_t m = 1; m < images.size(); ++m) {
        fmt::print(" {:+.2f} % |", 100.0 * (mean_irradiance(surface, images[m]) / judge - 1.0));
      }
    }
    fmt::print("\n| relmse of the picture | | |");
    for (std::size_t m = 1; m < images.size(); ++m) {
      fmt::print(" {:.2e} |", compare(images[m], images[0]).relmse);
    }
    fmt::print("\n| seconds | | {:.0f} |", seconds[0]);
    for (std::size_t m = 1; m < images.size(); ++m) fmt::print(" {:.0f} |", seconds[m]);
    fmt::print("\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "agreement: {}\n", e.what());
    return 1;
  }
}
