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

  /// Whether a side of a triangle emits.
  bool emits(std::uint32_t triangle, bool front) const {
    return !is_black(material(triangle).emission) && (front || material(triangle).double_sided);
  }

  /// A walk from a point of a side of the triangle.
  bool finds_light(std::uint32_t triangle, bool from_front, std::uint64_t key) const {
    // Light that needs more reflections than these adds nothing that could be seen.
    constexpr int kLongest = 8;
    Random random(key);
    const Vec2 uv = random.in_triangle();
    Vec3 normal = glm::normalize(world_.area_vector(triangle)) * (from_front ? 1.0f : -1.0f);
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

LitSides lit_sides(const Scene& scene, const World& world, const PatchMesh& mesh,
                   const Tracer& tracer) {
  // A side of which a hundredth of the walks find light is missed once in ten. Backs are mostly
  // those of solids, and there are many; fronts that no light comes to are few, and a miss shows.
  constexpr std::uint64_t kLeastWalks[] = {256, 4096};  // of backs, of fronts
  constexpr std::uint64_t kWalksOfTriangle = 4;
  Groups groups = surfaces_of(mesh);
  std::vector<std::vector<std::uint32_t>> members(mesh.size());
  for (std::uint32_t f = 0; f < mesh.size(); ++f) members[groups.find(f)].push_back(f);
  const Search search(scene, world, tracer);
  std::vector<std::uint8_t> lit(2 * mesh.size(), 0);
  parallel_for(lit.size(), 1, [&](std::size_t side) {
    const std::vector<std::uint32_t>& faces = members[side / 2];
    if (faces.empty()) return;
    const bool front = side % 2 == 1;
    const std::uint64_t walks =
        std::max<std::uint64_t>(kLeastWalks[side % 2], kWalksOfTriangle * faces.size());
    for (std::uint64_t walk = 0; walk < walks && lit[side] == 0; ++walk) {
      const std::uint32_t face = faces[walk % faces.size()];
      lit[side] = search.emits(face, front) || search.finds_light(face, front, hash(side, walk));
    }
  });
  LitSides result;
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    const std::size_t group = groups.find(f);
    result.back.push_back(lit[2 * group] != 0);
    result.front.push_back(lit[2 * group + 1] != 0);
  }
  return result;
}

bool is_covered(const World& world, const LitSides& lit, const Tracer& tracer, const Vec3& position,
                const Vec3& normal, std::uint64_t key) {
  // From a point in the open no ray ends at such a side, save through a crack; from inside a solid
  // every ray does.
  constexpr int kRays = 8;
  const Vec3 origin = off_surface(position, normal, world.coordinate_scale());
  Random random(key);
  for (int i = 0; i < kRays; ++i) {
    const Vec3 direction = Frame(normal).to_world(random.cosine_direction());
    const Hit hit = tracer.closest({.origin = origin, .direction = direction});
    if (!hit || lit(hit.triangle, glm::dot(world.area_vector(hit.triangle), direction) < 0.0f)) {
      return false;
    }
  }
  return true;
}

}  // namespace lantern
