// SPDX-License-Identifier: MIT
// How close the gather comes to raw Embree: the same shadow rays, in the same order, once shaded
// and once only traced, block by block in turn, so that both see the same noise of the machine.
//   gather_bench SCENE [--emitter P=R,G,B] [--sky R,G,B] [--look-at ...] [--fov D]
#include "lantern/gather/kernel.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/camera.h"
#include "lantern/pipeline/edits.h"
#include "lantern/pipeline/render.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/eye.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <chrono>
#include <cstring>

namespace {

using namespace lantern;
using Clock = std::chrono::steady_clock;

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Keeps the packets that the gather traces instead of tracing them.
class Recorder final : public Tracer {
 public:
  explicit Recorder(const Tracer& tracer) : tracer_(tracer) {}
  struct Traced {
    LaneMask active;
    RayPacket rays;
  };
  Hit closest(const Ray& ray) const override { return tracer_.closest(ray); }
  bool occluded(const Ray& ray) const override { return tracer_.occluded(ray); }
  void occluded(const LaneMask& active, RayPacket& packet) const override {
    if (used_ == packets_.size()) packets_.emplace_back();
    packets_[used_].active = active;
    packets_[used_].rays = packet;
    ++used_;
  }
  void closest(const LaneMask& active, RayPacket& packet, Hit* hits) const override {
    tracer_.closest(active, packet, hits);
  }
  std::span<Traced> packets() const { return std::span(packets_).first(used_); }
  void clear() const { used_ = 0; }

 private:
  const Tracer& tracer_;
  mutable std::vector<Traced> packets_;
  mutable std::size_t used_ = 0;
};

/// The shading points of a 4x4 block of pixels.
ShadingPacket see(const Scene& scene, const World& world, const Tracer& tracer,
                  const Camera& camera, int x0, int y0, int size) {
  ShadingPacket packet{};
  const Eye eye(camera, size, size);
  for (int i = 0; i < kPacket; ++i) {
    Ray ray;
    ray.origin = eye.origin();
    ray.direction =
        eye.direction(static_cast<float>(x0 + i % 4) + 0.5f, static_cast<float>(y0 + i / 4) + 0.5f);
    const Hit hit = tracer.closest(ray);
    if (!hit) continue;
    const SurfacePoint point = surface_at(scene, world, hit.triangle, hit.uv);
    const float side = glm::dot(point.geometric_normal, ray.direction) < 0.0f ? 1.0f : -1.0f;
    const Vec3 g = point.geometric_normal * side, s = point.shading_normal * side;
    const Vec3 p = off_surface(point.position, g, world.coordinate_scale());
    packet.x[i] = p.x;
    packet.y[i] = p.y;
    packet.z[i] = p.z;
    packet.shading_x[i] = s.x;
    packet.shading_y[i] = s.y;
    packet.shading_z[i] = s.z;
    packet.geometric_x[i] = g.x;
    packet.geometric_y[i] = g.y;
    packet.geometric_z[i] = g.z;
    packet.active.lane[i] = -1;
  }
  return packet;
}

void measure(const Scene& scene, const CameraChoice& choice) {
  constexpr int kSize = 512, kBlock = 4, kRow = 1, kStride = 16;
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Camera camera = choose_camera(scene, world, *tracer, choice, 1.0f);
  const Emitters emitters(scene, world);
  WalkOptions walk_with;
  walk_with.paths = 256;
  walk_with.reflectivity = mean_reflectivity(scene, world);

  const auto walk_start = Clock::now();
  WalkOptions many = walk_with;
  many.paths = 1 << 18;
  const VirtualLights crowd = walk(scene, world, *tracer, emitters, many);
  const double walk_seconds = seconds(Clock::now() - walk_start);

  const VirtualLights virtual_lights = walk(scene, world, *tracer, emitters, walk_with);
  const GatherLights lights(virtual_lights, world.coordinate_scale());
  const Recorder recorder(*tracer);

  double shaded = 0.0, raw = 0.0;
  std::uint64_t rays = 0, packets = 0;
  IrradiancePacket irradiance;
  const auto trace_recorded = [&] {
    const auto start = Clock::now();
    for (Recorder::Traced& packet : recorder.packets())
      tracer->occluded(packet.active, packet.rays);
    raw += seconds(Clock::now() - start);
  };
  // Rows of neighbouring blocks; who comes first, and so finds the caches cold, alternates.
  bool raw_first = false;
  for (int y = 0; y < kSize; y += kStride) {
    for (int x0 = 0; x0 < kSize; x0 += 2 * kBlock) {
      ShadingPacket points[kRow];
      recorder.clear();
      for (int i = 0; i < kRow; ++i) {
        points[i] = see(scene, world, *tracer, camera, x0 + i * kBlock, y, kSize);
        gather_irradiance(lights, points[i], recorder, kInfinity, ShadowRays::kPackets, irradiance);
      }
      raw_first = !raw_first;
      if (raw_first) trace_recorded();
      const auto start = Clock::now();
      for (const ShadingPacket& block : points) {
        rays +=
            gather_irradiance(lights, block, *tracer, kInfinity, ShadowRays::kPackets, irradiance);
      }
      shaded += seconds(Clock::now() - start);
      if (!raw_first) trace_recorded();
      packets += recorder.packets().size();
    }
  }
  const double all = static_cast<double>(rays);
  fmt::print("{:<44}{:>12}\n", "lights of 256 paths", lights.size());
  fmt::print("{:<44}{:>12.1f}\n", "rays in a packet of 16", all / static_cast<double>(packets));
  fmt::print("{:<44}{:>12.1f}\n", "raw occlusion, M rays/s, one core", all / raw * 1e-6);
  fmt::print("{:<44}{:>12.1f}\n", "gather with shading, M rays/s, one core", all / shaded * 1e-6);
  fmt::print("{:<44}{:>12.3f}\n", "gather over raw", raw / shaded);
  fmt::print("{:<44}{:>12.3f}\n", "share of shading and ray set-up", 1.0 - raw / shaded);
  fmt::print("{:<44}{:>12.2f}\n", "walk, M lights/s, one core",
             static_cast<double>(crowd.size()) / walk_seconds * 1e-6);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Gather against raw Embree over the same rays");
  std::string scene_path, look_at, sky;
  std::vector<std::string> emitters;
  float fov = 0.0f;
  app.add_option("scene", scene_path)->required();
  app.add_option("--emitter", emitters);
  app.add_option("--sky", sky);
  app.add_option("--look-at", look_at);
  app.add_option("--fov", fov);
  CLI11_PARSE(app, argc, argv);
  try {
    Loaded loaded = load_scene(scene_path);
    for (const std::string& text : emitters) apply(parse_emitter(text), loaded.scene);
    if (!sky.empty()) set_sky(parse_sky(sky), loaded.scene);
    CameraChoice choice;
    if (fov > 0.0f) choice.vertical_fov = glm::radians(fov);
    if (!look_at.empty()) {
      const std::vector<float> v = parse_numbers(look_at);
      choice.eye = Vec3(v.at(0), v.at(1), v.at(2));
      choice.target = Vec3(v.at(3), v.at(4), v.at(5));
    }
    ThreadScope one(1);
    measure(loaded.scene, choice);
  } catch (const std::exception& e) {
    fmt::print(stderr, "gather_bench: {}\n", e.what());
    return 1;
  }
}
