// SPDX-License-Identifier: MIT
// Scenes whose light is known in closed form, built in code, and the means of passes over them.
#pragma once

#include "lantern/gather/kernel.h"
#include "lantern/lights/emitters.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/tracer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lantern::test {

/// A scene made ready: the parts refer to each other, so it stays where it is.
struct Stage {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;
  Emitters emitters;

  explicit Stage(Scene given)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)),
        emitters(scene, world) {}
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
};

inline MaterialId add_material(Scene& scene, float reflectance, float emission) {
  const auto id = static_cast<MaterialId>(scene.materials.size());
  Material& material = scene.materials.emplace_back();
  material.name = "material " + std::to_string(scene.materials.size());
  material.reflectance = Rgb(reflectance);
  material.emission = Rgb(emission);
  return id;
}

/// The mesh, to be changed further; its instance has no transform.
inline Mesh& add_mesh(Scene& scene, MaterialId material, std::vector<Vec3> positions,
                      std::vector<uvec3> triangles) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  mesh.material = material;
  scene.instances.emplace_back().mesh = static_cast<MeshId>(scene.meshes.size());
  return scene.meshes.emplace_back(std::move(mesh));
}

/// The parallelogram of two edges at `corner`; its front is the side of cross(u, v).
inline Mesh& add_quad(Scene& scene, MaterialId material, const Vec3& corner, const Vec3& u,
                      const Vec3& v) {
  Mesh& mesh = add_mesh(scene, material, {corner, corner + u, corner + u + v, corner + v},
                        {{0, 1, 2}, {0, 2, 3}});
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return mesh;
}

/// A box around the origin whose walls face inward.
inline Scene box_room(const Vec3& size, float reflectance, float emission) {
  Scene scene;
  const MaterialId walls = add_material(scene, reflectance, emission);
  const Vec3 low = -0.5f * size, high = 0.5f * size;
  const Vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(scene, walls, low, y, z);
  add_quad(scene, walls, low, z, x);
  add_quad(scene, walls, low, x, y);
  add_quad(scene, walls, high, -z, -y);
  add_quad(scene, walls, high, -x, -z);
  add_quad(scene, walls, high, -y, -x);
  return scene;
}

/// An octahedron whose faces are split in four `splits` times, blown up to the unit sphere; the
/// faces look inward.
inline Scene sphere_room(int splits, float reflectance, float emission) {
  std::vector<Vec3> corners;  // three for each face, counter-clockwise from inside
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sy : {-1.0f, 1.0f}) {
      for (const float sz : {-1.0f, 1.0f}) {
        const Vec3 a(sx, 0, 0), b(0, sy, 0), c(0, 0, sz);
        const bool swap = sx * sy * sz > 0.0f;
        corners.insert(corners.end(), {a, swap ? c : b, swap ? b : c});
      }
    }
  }
  for (int split = 0; split < splits; ++split) {
    std::vector<Vec3> finer;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      const Vec3 a = corners[i], b = corners[i + 1], c = corners[i + 2];
      const Vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    corners = std::move(finer);
  }
  std::vector<uvec3> triangles;
  for (std::uint32_t i = 0; i < corners.size(); i += 3) triangles.emplace_back(i, i + 1, i + 2);
  Scene scene;
  add_mesh(scene, add_material(scene, reflectance, emission), std::move(corners),
           std::move(triangles));
  return scene;
}

inline double total_area(const World& world) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < world.size(); ++t) sum += static_cast<double>(world.area(t));
  return sum;
}

struct Receiver {
  Vec3 position;
  Vec3 normal;
};

/// What the rays of `directions` from `eye` hit, lifted off the surface, on the side they see.
inline std::vector<Receiver> receivers_around(const Stage& stage, const Vec3& eye,
                                              std::span<const Vec3> directions) {
  std::vector<Receiver> receivers;
  for (const Vec3& direction : directions) {
    const Hit hit = stage.tracer->closest({.origin = eye, .direction = direction});
    assert(hit);
    Vec3 normal = glm::normalize(stage.world.area_vector(hit.triangle));
    if (glm::dot(normal, direction) > 0.0f) normal = -normal;
    receivers.push_back(
        {off_surface(eye + direction * hit.distance, normal, stage.world.coordinate_scale()),
         normal});
  }
  return receivers;
}

/// At most sixteen receivers as the gather takes them; the rest of the lanes idle.
inline ShadingPacket packet_of(std::span<const Receiver> receivers) {
  assert(receivers.size() <= kPacket);
  ShadingPacket packet{};
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const auto& [position, normal] = receivers[i];
    packet.set(i, position, normal, normal);
  }
  return packet;
}

/// Irradiance at up to sixteen receivers; the bound is in 1/m².
inline std::vector<Rgb> irradiance_at(const Stage& stage, const VirtualLights& lights,
                                      std::span<const Receiver> receivers,
                                      float bound = kInfinity) {
  const GatherLights ready(lights, stage.world.coordinate_scale());
  IrradiancePacket irradiance;
  gather_irradiance(ready, packet_of(receivers), *stage.tracer, bound, ShadowRays::kPackets,
                    irradiance);
  std::vector<Rgb> result;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    result.emplace_back(irradiance.r[i], irradiance.g[i], irradiance.b[i]);
  }
  return result;
}

/// Mean over passes and its standard error. Passes of a quasi-random sequence are not independent;
/// means of long runs of them nearly are: the error is that of kBatches batch means, which for
/// anticorrelated passes is too large rather than too small.
class PassMean {
 public:
  static constexpr std::size_t kBatches = 16;

  explicit PassMean(std::size_t passes) : per_batch_(std::max<std::size_t>(1, passes / kBatches)) {}

  void add(double value) {
    if (count_ % per_batch_ == 0) batches_.push_back(0.0);
    batches_.back() += value;
    ++count_;
    sum_ += value;
  }
  double mean() const { return sum_ / static_cast<double>(count_); }
  double standard_error() const {
    double mean = 0.0, square = 0.0;
    const std::size_t n =
        std::min(kBatches, batches_.size());  // the last, short one does not count
    for (std::size_t i = 0; i < n; ++i) mean += batches_[i];
    mean /= static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) square += (batches_[i] - mean) * (batches_[i] - mean);
    return std::sqrt(square / static_cast<double>(n * (n - 1))) / static_cast<double>(per_batch_);
  }

 private:
  std::size_t per_batch_;
  std::size_t count_ = 0;
  double sum_ = 0.0;
  std::vector<double> batches_;
};

/// Irradiance that a polygon of constant radiance makes at the origin of `corners` on a surface
/// with that normal; the polygon is seen whole and from its front, its corners in either order.
/// [Lambert 1760, Photometria; as a sum over edges: Baum, Rushmeier & Winget 1989, equation 5]
inline double polygon_irradiance(std::span<const glm::dvec3> corners, const glm::dvec3& normal,
                                 double radiance) {
  // What lies below the horizon is cut off. [Sutherland & Hodgman 1974]
  std::vector<glm::dvec3> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = corners[i], b = corners[(i + 1) % corners.size()];
    const double above_a = glm::dot(a, normal), above_b = glm::dot(b, normal);
    if (above_a >= 0.0) seen.push_back(a);
    if (above_a * above_b < 0.0) seen.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 a = seen[i], b = seen[(i + 1) % seen.size()];
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, normal);
  }
  return 0.5 * radiance * std::abs(sum);
}

/// The flux of all lights of a bounce, green channel.
inline double flux_of_bounce(const VirtualLights& lights, std::uint32_t bounce) {
  double sum = 0.0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights.bounce[i] == bounce) sum += static_cast<double>(lights.flux[i].g);
  }
  return sum;
}

}  // namespace lantern::test
