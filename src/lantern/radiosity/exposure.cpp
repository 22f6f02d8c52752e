// SPDX-License-Identifier: MIT
#include "lantern/radiosity/exposure.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/radiosity/random.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace lantern {
namespace {

/// Sets of triangles that are joined one pair at a time.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Joins faces over edges that just two of them share, their fronts on the same side.
Groups surfaces_of(const PatchMesh& mesh) {
  struct Side {
    std::uint32_t face;
    std::uint32_t count;
    bool forward, opposed;
  };
  std::unordered_map<std::uint64_t, Side> sides;
  sides.reserve(3 * mesh.size());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> pairs;  // edge, second face
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.faces[f].vertices[k], b = mesh.faces[f].vertices[(k + 1) % 3];
      const std::uint64_t key = (std::min(a, b) << 32) | std::max(a, b);
      const auto [entry, is_new] = sides.try_emplace(key, Side{f, 1, a < b, false});
      if (is_new) continue;
      ++entry->second.count;
      entry->second.opposed = entry->second.forward != (a < b);
      pairs.emplace_back(key, f);
    }
  }
  Groups groups(mesh.size());
  for (const auto& [key, face] : pairs) {
    const Side& side = sides.at(key);
    if (side.count == 2 && side.opposed) groups.join(side.face, face);
  }
  return groups;
}

/// Looks for light from points of the scene.
class Search {
 public:
  Search(const Scene& scene, const World& world, const Tracer& tracer)
      : scene_(scene), world_(world), tracer_(tracer), scale_(world.coordinate_scale()) {
    for (std::uint32_t t = 0; t < world.size(); ++t) {
      if (!is_black(material(t).emission)) emitters_.push_back(t);
    }
  }

  /// A walk from a point of the triangle's back.
  bool finds_light(std::uint32_t triangle, std::uint64_t key) const {
    // Light that needs more reflections than these adds nothing that could be seen.
    constexpr int kLongest = 8;
    Random random(key);
    const Vec2 uv = random.in_triangle();
    Vec3 normal = -glm::normalize(world_.area_vector(triangle));
    Vec3 position = point(triangle, uv);
    for (int step = 0; step < kLongest; ++step) {
      const Vec3 origin = off_surface(position, normal, scale_);
      if (sees_light(origin, normal, random)) return true;
      const Vec3 direction = Frame(normal).to_world(random.cosine_direction());
      const Hit hit = tracer_.closest({.origin = origin, .direction = direction});
      if (!hit) return scene_.sky.has_value();
      const Vec3 area = world_.area_vector(hit.triangle);
      const bool front = glm::dot(area, direction) < 0.0f;
      if (emits(hit.triangle, front)) return true;
      normal = glm::normalize(front ? area : -area);
      position = point(hit.triangle, hit.uv);
    }
    return false;
  }

 private:
  const Material& material(std::uint32_t triangle) const {
    return scene_.materials[index(world_.materials[triangle])];
  }
  bool emits(std::uint32_t triangle, bool front) const {
    return !is_black(material(triangle).emission) && (front || material(triangle).double_sided);
  }
  Vec3 point(std::uint32_t triangle, Vec2 uv) const {
    const uvec3 v = world_.triangles[triangle];
    return world_.positions[v.x] * (1.0f - uv.x - uv.y) + world_.positions[v.y] * uv.x +
           world_.positions[v.z] * uv.y;
  }

  /// Asks one emitter and one punctual light, chosen at random.
  bool sees_light(const Vec3& origin, const Vec3& normal, Random& random) const {
    if (!emitters_.empty()) {
      const std::uint32_t emitter = emitters_[random.index(emitters_.size())];
      const Vec3 on_emitter = point(emitter, random.in_triangle());
      Vec3 area = glm::normalize(world_.area_vector(emitter));
      const bool front = glm::dot(area, origin - on_emitter) > 0.0f;
      if (!front) area = -area;
      const Vec3 way = off_surface(on_emitter, area, scale_) - origin;
      if (emits(emitter, front) && glm::dot(way, normal) > 0.0f &&
          !tracer_.occluded({.origin = origin, .direction = way, .far = 1.0f})) {
        return true;
      }
    }
    if (scene_.lights.empty()) return false;
    const PunctualLight& light = scene_.lights[random.index(scene_.lights.size())];
    const bool far = light.kind == PunctualKind::kDirectional;
    const Vec3 way = far ? -light.direction : light.position - origin;
    return glm::dot(way, normal) > 0.0f &&
           !tracer_.occluded({.origin = origin, .direction = way, .far = far ? kInfinity : 1.0f});
  }

  const Scene& scene_;
  const World& world_;
  const Tracer& tracer_;
  float scale_;
  std::vector<std::uint32_t> emitters_;
};

}  // namespace

std::vector<bool> lit_backs(const Scene& scene, const World& world, const PatchMesh& mesh,
                            const Tracer& tracer) {
  // Enough that a surface of which a hundredth sees light is found with a probability of 0.92.
  constexpr std::uint64_t kLeastWalks = 256;
  constexpr std::uint64_t kWalksOfTriangle = 4;
  Groups groups = surfaces_of(mesh);
  std::vector<std::vector<std::uint32_t>> members(mesh.size());
  for (std::uint32_t f = 0; f < mesh.size(); ++f) members[groups.find(f)].push_back(f);
  const Search search(scene, world, tracer);
  std::vector<std::uint8_t> lit(mesh.size(), 0);
  parallel_for(mesh.size(), 1, [&](std::size_t group) {
    const std::vector<std::uint32_t>& faces = members[group];
    if (faces.empty()) return;
    const std::uint64_t walks =
        std::max<std::uint64_t>(kLeastWalks, kWalksOfTriangle * faces.size());
    for (std::uint64_t walk = 0; walk < walks && lit[group] == 0; ++walk) {
      const std::uint32_t face = faces[walk % faces.size()];
      const Material& material = scene.materials[index(world.materials[face])];
      const bool shines = material.double_sided && !is_black(material.emission);
      if (shines || search.finds_light(face, hash(group, walk))) lit[group] = 1;
    }
  });
  std::vector<bool> result(mesh.size());
  for (std::uint32_t f = 0; f < mesh.size(); ++f) result[f] = lit[groups.find(f)] != 0;
  return result;
}

bool is_covered(const World& world, const std::vector<bool>& lit_back, const Tracer& tracer,
                const Vec3& position, const Vec3& normal, std::uint64_t key) {
  // From a point in the open no ray ends at such a back, save through a crack; from inside a solid
  // every ray does, save those that meet another thing inside.
  constexpr int kRays = 8;
  const Vec3 origin = off_surface(position, normal, world.coordinate_scale());
  Random random(key);
  for (int i = 0; i < kRays; ++i) {
    const Vec3 direction = Frame(normal).to_world(random.cosine_direction());
    const Hit hit = tracer.closest({.origin = origin, .direction = direction});
    if (!hit || glm::dot(world.area_vector(hit.triangle), direction) < 0.0f ||
        lit_back[hit.triangle]) {
      return false;
    }
  }
  return true;
}

}  // namespace lantern
