// SPDX-License-Identifier: MIT
#include "lantern/trace/brute_force.h"

#include "lantern/scene/surface.h"

#include <optional>

namespace lantern {
namespace {

using glm::dvec2;
using glm::dvec3;

struct Crossing {
  double distance = 0.0;
  dvec2 uv{0.0};
};

/// Where the ray's line crosses the triangle, from either side; edges belong to it.
/// [Möller & Trumbore 1997]
std::optional<Crossing> intersect(const Ray& ray, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 direction(ray.direction), ab = b - a, ac = c - a;
  const dvec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0.0) return std::nullopt;
  const dvec3 from_a = dvec3(ray.origin) - a;
  const dvec3 q = glm::cross(from_a, ab);
  const dvec2 uv = dvec2(glm::dot(from_a, p), glm::dot(direction, q)) / determinant;
  if (!(uv.x >= 0.0 && uv.y >= 0.0 && uv.x + uv.y <= 1.0)) return std::nullopt;
  return Crossing{glm::dot(ac, q) / determinant, uv};
}

Ray lane(const RayPacket& packet, int i) {
  return {.origin = {packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]},
          .direction = {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]},
          .near = packet.near[i],
          .far = packet.far[i]};
}

class BruteForceTracer : public Tracer {
 public:
  BruteForceTracer(const Scene& scene, const World& world) : scene_(scene), world_(world) {}

  Hit closest(const Ray& ray) const override {
    Hit hit;
    Ray rest = ray;
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (const Hit nearer = meet(rest, i)) {
        hit = nearer;
        rest.far = nearer.distance;
      }
    }
    return hit;
  }

  bool occluded(const Ray& ray) const override {
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (meet(ray, i)) return true;
    }
    return false;
  }

  void occluded(const LaneMask& active, RayPacket& packet) const override {
    for (int i = 0; i < kPacket; ++i) {
      if (active.lane[i] != 0 && occluded(lane(packet, i))) packet.far[i] = -kInfinity;
    }
  }

  void closest(const LaneMask& active, RayPacket& packet, Hit* hits) const override {
    for (int i = 0; i < kPacket; ++i) {
      hits[i] = active.lane[i] != 0 ? closest(lane(packet, i)) : Hit{};
    }
  }

 private:
  /// The hit of one triangle behind `near` and not behind `far`, unless it is a hole.
  Hit meet(const Ray& ray, std::uint32_t triangle) const {
    const uvec3 v = world_.triangles[triangle];
    const auto crossing =
        intersect(ray, world_.positions[v.x], world_.positions[v.y], world_.positions[v.z]);
    if (!crossing || !(crossing->distance > static_cast<double>(ray.near)) ||
        !(crossing->distance <= static_cast<double>(ray.far))) {
      return {};
    }
    const Hit hit{.distance = static_cast<float>(crossing->distance),
                  .triangle = triangle,
                  .uv = Vec2(crossing->uv)};
    return is_hole(scene_, world_, triangle, hit.uv, ray.origin, ray.direction) ? Hit{} : hit;
  }

  const Scene& scene_;
  const World& world_;
};

}  // namespace

std::unique_ptr<Tracer> make_brute_force_tracer(const Scene& scene, const World& world) {
  return std::make_unique<BruteForceTracer>(scene, world);
}

}  // namespace lantern
