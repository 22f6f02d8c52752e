// SPDX-License-Identifier: MIT
#include "lantern/raster/edge_list.h"

#include "lantern/raster/silhouettes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lantern {
namespace {

using glm::dvec3;

/// Planes are this exact: the distance by which shadow rays are kept off surfaces.
float rounding_of(const World& world) { return 0x1p-18f * world.coordinate_scale(); }

float signed_distance(const Vec4& plane, const Vec3& p) {
  return glm::dot(Vec3(plane), p) + plane.w;
}

bool lies_in(const Vec4& plane, const Vec3& p, float rounding) {
  return std::abs(signed_distance(plane, p)) <= rounding;
}

/// The plane through the triangle that has the whole scene on one side; w = NaN: there is none.
Vec4 supporting_plane(const World& world, std::uint32_t triangle, float rounding) {
  const Vec3 normal = glm::normalize(world.area_vector(triangle));
  const Vec4 plane(normal, -glm::dot(normal, world.positions[world.triangles[triangle].x]));
  bool before = true, behind = true;
  for (const uvec3& t : world.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const float distance = signed_distance(plane, world.positions[t[corner]]);
      before &= distance >= -rounding;
      behind &= distance <= rounding;
    }
    if (!before && !behind) return Vec4(std::nanf(""));
  }
  return before ? plane : -plane;
}

/// Volumes around the eye that `line` leads to: 1 for each of these triangles whose front faces the
/// light, -1 for each whose back does.
int count_of(std::span<const uvec3> triangles, const EyeLine& line) {
  int count = 0;
  for (const uvec3& triangle : triangles) {
    if (line.is_parted_by(triangle)) count += line.crossing(triangle);
  }
  return count;
}

class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The smaller representative stays, so that the order of parts is that of the triangles.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<Vec4> find_walls(const World& world) {
  // A wall's number is a bit of a mask. Only large triangles are worth the search.
  constexpr std::size_t kMostWalls = 32, kMostCandidates = 512;
  std::vector<std::uint32_t> order(world.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<float> areas(world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) areas[t] = world.area(t);
  const auto larger = [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(areas[b], a) < std::tie(areas[a], b);
  };
  const std::size_t candidates = std::min(kMostCandidates, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(candidates),
                    order.end(), larger);
  const float rounding = rounding_of(world);
  std::vector<Vec4> walls;
  for (std::size_t i = 0; i < candidates && walls.size() < kMostWalls; ++i) {
    if (wall_of(world, order[i], walls)) continue;
    const Vec4 plane = supporting_plane(world, order[i], rounding);
    if (!std::isnan(plane.w)) walls.push_back(plane);
  }
  return walls;
}

bool is_inside(std::span<const Vec4> walls, const LightPoint& point) {
  return std::all_of(walls.begin(), walls.end(),
                     [&](const Vec4& wall) { return glm::dot(wall, point) >= 0.0f; });
}

std::optional<std::size_t> wall_of(const World& world, std::uint32_t triangle,
                                   std::span<const Vec4> walls) {
  const float rounding = rounding_of(world);
  const uvec3 t = world.triangles[triangle];
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (lies_in(walls[w], world.positions[t.x], rounding) &&
        lies_in(walls[w], world.positions[t.y], rounding) &&
        lies_in(walls[w], world.positions[t.z], rounding)) {
      return w;
    }
  }
  return std::nullopt;
}

EdgeList::EdgeList(const World& world, std::span<const Vec4> walls) {
  assert(walls.size() <= 32);
  weld(world);
  const float rounding = rounding_of(world);
  std::vector<std::uint32_t> masks(vertices_.size(), 0u);
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (lies_in(walls[w], vertices_[v], rounding)) masks[v] |= 1u << w;
    }
  }
  std::erase_if(casters_,
                [&](const uvec3& t) { return (masks[t.x] & masks[t.y] & masks[t.z]) != 0; });
  find_edges(masks);
  sort_by_part();
  for (const uvec3& t : casters_) {
    const dvec3 a(vertices_[t.x]);
    const dvec3 normal = glm::cross(dvec3(vertices_[t.y]) - a, dvec3(vertices_[t.z]) - a);
    planes_.emplace_back(Vec3(normal), static_cast<float>(-glm::dot(normal, a)));
  }
  for (Part& part : parts_) part.convex = is_convex(part);
}

void EdgeList::weld(const World& world) {
  std::vector<std::uint32_t> order(world.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = world.positions[i];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> welded(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || key(order[i]) != key(order[i - 1])) {
      vertices_.push_back(world.positions[order[i]]);
    }
    welded[order[i]] = static_cast<std::uint32_t>(vertices_.size() - 1);
  }
  for (const uvec3& t : world.triangles) {
    casters_.emplace_back(welded[t.x], welded[t.y], welded[t.z]);
  }
}

void EdgeList::find_edges(std::span<const std::uint32_t> wall_masks) {
  struct Side {
    std::uint32_t a, b, face;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * casters_.size());
  for (std::uint32_t t = 0; t < casters_.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = casters_[t][corner], to = casters_[t][(corner + 1) % 3];
      if ((wall_masks[from] & wall_masks[to]) != 0) continue;
      sides.push_back({std::min(from, to), std::max(from, to), 2 * t + (from < to ? 0u : 1u)});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (const Side& side : sides) {
    if (edges_.empty() || edges_.back().a != side.a || edges_.back().b != side.b) {
      edges_.push_back({side.a, side.b, static_cast<std::uint32_t>(faces_.size())});
    }
    faces_.push_back(side.face);
  }
}

void EdgeList::sort_by_part() {
  const auto end_of = [&](std::size_t e) {
    return e + 1 < edges_.size() ? edges_[e + 1].first : static_cast<std::uint32_t>(faces_.size());
  };
  Sets sets(casters_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (std::uint32_t f = edges_[e].first + 1; f < end_of(e); ++f) {
      sets.join(faces_[f - 1] / 2, faces_[f] / 2);
    }
  }
  std::vector<std::uint8_t> odd(casters_.size(), 0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if ((end_of(e) - edges_[e].first) % 2 != 0) odd[sets.find(faces_[edges_[e].first] / 2)] = 1;
  }

  const auto part_of = [&](std::uint32_t caster) { return sets.find(caster); };
  std::vector<std::uint32_t> order(casters_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return part_of(a) < part_of(b); });
  std::vector<std::uint32_t> place(order.size());
  std::vector<uvec3> sorted;
  std::vector<Bounds> bounds;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    sorted.push_back(casters_[order[i]]);
    if (i == 0 || part_of(order[i]) != part_of(order[i - 1])) {
      parts_.push_back({i, 0, odd[part_of(order[i])] == 0, Vec3(0.0f), 0.0f});
      bounds.emplace_back();
    }
    ++parts_.back().casters;
    for (int corner = 0; corner < 3; ++corner) bounds.back().add(vertices_[sorted[i][corner]]);
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    Part& part = parts_[p];
    part.centre = bounds[p].centre();
    for (std::uint32_t i = part.first_caster; i < part.first_caster + part.casters; ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const float distance = glm::distance(vertices_[sorted[i][corner]], part.centre);
        part.radius = std::max(part.radius, distance);
      }
    }
  }

  std::vector<std::uint32_t> edge_order(edges_.size());
  std::iota(edge_order.begin(), edge_order.end(), 0u);
  const auto first_place = [&](std::uint32_t e) { return place[faces_[edges_[e].first] / 2]; };
  std::vector<std::uint32_t> part_of_caster;
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    part_of_caster.insert(part_of_caster.end(), parts_[p].casters, p);
  }
  const auto part_of_edge = [&](std::uint32_t e) { return part_of_caster[first_place(e)]; };
  const auto is_paired = [&](std::uint32_t e) {
    const std::uint32_t first = edges_[e].first;
    return end_of(e) - first == 2 && (faces_[first] ^ faces_[first + 1]) % 2 != 0;
  };
  std::stable_sort(edge_order.begin(), edge_order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(part_of_edge(a), !is_paired(a)) < std::pair(part_of_edge(b), !is_paired(b));
  });
  std::vector<Edge> edges;
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t e : edge_order) {
    Part& part = parts_[part_of_edge(e)];
    if (part.edges++ == 0) part.first_edge = static_cast<std::uint32_t>(edges.size());
    if (is_paired(e)) ++part.paired_edges;
    edges.push_back({edges_[e].a, edges_[e].b, static_cast<std::uint32_t>(faces.size())});
    for (std::uint32_t f = edges_[e].first; f < end_of(e); ++f) {
      faces.push_back(2 * place[faces_[f] / 2] + faces_[f] % 2);
    }
  }
  edges_ = std::move(edges);
  faces_ = std::move(faces);
  casters_ = std::move(sorted);
}

/// Whether the part is closed and convex: a connected closed mesh is where it turns to one side at
/// all its edges, but for rounding.
bool EdgeList::is_convex(const Part& part) const {
  const bool is_closed = part.paired_edges == part.edges && 2 * part.edges == 3 * part.casters;
  if (!is_closed) return false;
  // All that may turn the other way, in radians: of a fine mesh no edge turns by much.
  constexpr float kRounding = 0.05f;
  float to_front = 0.0f, to_back = 0.0f;
  for (std::uint32_t e = part.first_edge; e < part.first_edge + part.edges; ++e) {
    const Edge& edge = edges_[e];
    const std::uint32_t one = faces_[edge.first] / 2, other = faces_[edge.first + 1] / 2;
    const float area = glm::length(Vec3(planes_[one])),
                of_other = glm::length(Vec3(planes_[other]));
    if (area == 0.0f || of_other == 0.0f) return false;
    const float height = of_other / glm::distance(vertices_[edge.a], vertices_[edge.b]);
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = casters_[other][corner];
      if (vertex == edge.a || vertex == edge.b) continue;
      const float angle = signed_distance(planes_[one], vertices_[vertex]) / (area * height);
      (angle > 0.0f ? to_front : to_back) += std::abs(angle);
    }
  }
  return std::min(to_front, to_back) <= kRounding;
}

std::int8_t EdgeList::facing(std::uint32_t caster, const LightPoint& light) const {
  const Vec4& p = planes_[caster];
  const float side = p.x * light.x + p.y * light.y + p.z * light.z + p.w * light.w;
  return side >= 0.0f ? std::int8_t{1} : std::int8_t{-1};
}

std::vector<std::int8_t> EdgeList::facing(const LightPoint& light) const {
  std::vector<std::int8_t> signs(planes_.size());
  for (std::uint32_t t = 0; t < planes_.size(); ++t) signs[t] = facing(t, light);
  return signs;
}

bool EdgeList::is_outside(const Part& part, const LightPoint& light, std::span<const Vec4> region) {
  // The shadow widens on its way.
  const Vec3 way = light.w * part.centre - Vec3(light);
  return std::any_of(region.begin(), region.end(), [&](const Vec4& plane) {
    return signed_distance(plane, part.centre) < -part.radius &&
           glm::dot(Vec3(plane), way) <= -light.w * part.radius;
  });
}

void EdgeList::append_edges(const Part& part, std::span<const std::int8_t> light_side, bool halved,
                            std::vector<VolumeEdge>& edges) const {
  if (part.edges == 0) return;
  // Most edges run between two triangles: where both face the light alike there is nothing to do.
  const std::uint32_t* faces = faces_.data() + edges_[part.first_edge].first;
  for (std::size_t e = part.first_edge; e < part.first_edge + part.paired_edges; ++e, faces += 2) {
    const int side = light_side[faces[0] / 2];
    if (side == light_side[faces[1] / 2]) continue;
    const bool forwards = (side > 0) == (faces[0] % 2 == 0);
    const VolumeEdge edge =
        forwards ? VolumeEdge{edges_[e].a, edges_[e].b} : VolumeEdge{edges_[e].b, edges_[e].a};
    edges.insert(edges.end(), halved ? 1 : 2, edge);
  }
  for (std::size_t e = part.first_edge + part.paired_edges; e < part.first_edge + part.edges; ++e) {
    const std::uint32_t end =
        e + 1 < edges_.size() ? edges_[e + 1].first : static_cast<std::uint32_t>(faces_.size());
    int times = 0;
    for (std::uint32_t f = edges_[e].first; f < end; ++f) {
      const int side = light_side[faces_[f] / 2];
      times += faces_[f] % 2 == 0 ? side : -side;
    }
    if (halved) times /= 2;
    for (; times > 0; --times) edges.push_back({edges_[e].a, edges_[e].b});
    for (; times < 0; ++times) edges.push_back({edges_[e].b, edges_[e].a});
  }
}

/// Of the part's volumes around the eye; `line` leads to it.
int EdgeList::count_at_eye(const Part& part, std::span<const std::int8_t> light_side,
                           const EyeLine& line, const Vec3& eye) const {
  int count = 0;
  for (std::uint32_t t = part.first_caster; t < part.first_caster + part.casters; ++t) {
    const double eye_side =
        glm::dot(dvec3(planes_[t]), dvec3(eye) - dvec3(vertices_[casters_[t].x]));
    if ((eye_side >= 0.0) == (light_side[t] > 0)) continue;
    count += light_side[t] * line.crossing(casters_[t]);
  }
  return count;
}

/// How far the part's silhouette may be off to be so by no more than the angle for eye and light.
float EdgeList::silhouette_slack(const Part& part, const LightPoint& light, const Vec3& eye,
                                 float angle) {
  // What is smaller than a pixel keeps its shape all the same: chords cut its shadow down.
  constexpr float kOfRadius = 0.015f;
  float nearest = glm::distance(eye, part.centre);
  if (light.w != 0.0f) nearest = std::min(nearest, glm::distance(Vec3(light), part.centre));
  return std::min(kOfRadius * part.radius, angle * std::max(nearest - part.radius, 0.0f));
}

ShadowVolumes EdgeList::volumes(const LightPoint& light, const Vec3& eye, VolumeCount count,
                                std::span<const Vec4> region, float slack) const {
  std::vector<std::int8_t> light_side(planes_.size());
  const EyeLine line(vertices_, light, eye);
  std::optional<SilhouetteSimplifier> simplifier;
  if (slack > 0.0f) simplifier.emplace(vertices_, light);
  ShadowVolumes result;
  for (const Part& part : parts_) {
    if (is_outside(part, light, region)) continue;
    for (std::uint32_t t = part.first_caster; t < part.first_caster + part.casters; ++t) {
      light_side[t] = facing(t, light);
    }
    const bool may_shadow_eye = line.meets(part.centre, part.radius);
    const bool halved = part.even && count == VolumeCount::kHalved;
    const std::size_t first = result.edges.size();
    append_edges(part, light_side, halved, result.edges);
    int of_eye = may_shadow_eye ? count_at_eye(part, light_side, line, eye) : 0;
    if (halved) {
      // An odd count of triangles at the eye is an odd one, so never none, wherever it looks.
      result.dark |= of_eye % 2 != 0;
      of_eye /= 2;
      if (simplifier && part.convex) {
        const float distance = silhouette_slack(part, light, eye, slack);
        const auto left_out = simplifier->simplify(result.edges, first, distance);
        if (may_shadow_eye) of_eye -= count_of(left_out, line);
      }
    }
    result.eye_count += of_eye;
  }
  return result;
}

bool is_clear_of(const EdgeList& list, const ShadowVolumes& volumes, const LightPoint& light,
                 const Vec3& eye, float distance) {
  const dvec3 e(eye), l(light);
  const double w = light.w;
  for (const VolumeEdge& edge : volumes.edges) {
    // The quad's plane holds the two ways down from the edge's ends.
    const dvec3 a(list.vertices()[edge.from]), b(list.vertices()[edge.to]);
    const dvec3 down_a = w * a - l, down_b = w * b - l, down_e = w * e - l;
    const dvec3 normal = w != 0.0 ? glm::cross(down_a, down_b) : glm::cross(l, b - a);
    const double off = glm::dot(normal, e - a);
    if (off * off > static_cast<double>(distance) * distance * glm::dot(normal, normal)) continue;
    const bool between = w == 0.0 || (glm::dot(glm::cross(down_a, down_e), normal) >= 0.0 &&
                                      glm::dot(glm::cross(down_e, down_b), normal) >= 0.0);
    if (between) return false;
  }
  return true;
}

}  // namespace lantern
