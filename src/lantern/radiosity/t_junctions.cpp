// SPDX-License-Identifier: MIT
#include "lantern/radiosity/t_junctions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// Nearer to an edge's ends, or with the third corner nearer to the edge, than so many tolerances
/// a cut would leave slivers.
constexpr double kClear = 64.0;

/// An edge that one face has alone.
struct Border {
  std::uint32_t face;
  int side;  // from this corner to the next
  std::uint32_t a, b;
};

std::vector<Border> borders_of(const PatchMesh& mesh) {
  std::vector<Border> sides;
  sides.reserve(3 * mesh.size());
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    const uvec3 v = mesh.faces[f].vertices;
    for (int k = 0; k < 3; ++k) sides.push_back({f, k, v[k], v[(k + 1) % 3]});
  }
  const auto key = [](const Border& s) { return std::minmax(s.a, s.b); };
  std::sort(sides.begin(), sides.end(), [&](const Border& a, const Border& b) {
    return std::pair(key(a), a.face) < std::pair(key(b), b.face);
  });
  std::vector<Border> alone;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool as_before = i > 0 && key(sides[i - 1]) == key(sides[i]);
    const bool as_after = i + 1 < sides.size() && key(sides[i + 1]) == key(sides[i]);
    if (!as_before && !as_after) alone.push_back(sides[i]);
  }
  return alone;
}

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

/// A vertex on a side of a face: how far along, from 0 to 1.
struct OnSide {
  std::uint32_t face;
  int side;
  double along;
  std::uint32_t vertex;
};

/// Finds the vertices on borders, halving the vertices until few are left.
class Finder {
 public:
  Finder(const PatchMesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance) {}

  void find(const std::vector<Border>& borders, std::span<std::uint32_t> vertices) {
    constexpr std::size_t kFew = 8;
    Box box;
    for (const std::uint32_t v : vertices) box.add(mesh_.positions[v]);
    std::vector<Border> near;
    for (const Border& border : borders) {
      if (meets(border, box)) near.push_back(border);
    }
    if (near.empty()) return;
    if (vertices.size() <= kFew) {
      for (const Border& border : near) {
        for (const std::uint32_t v : vertices) test(border, v);
      }
      return;
    }
    const glm::dvec3 extent = box.high - box.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const auto middle = vertices.size() / 2;
    std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(middle),
                     vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(mesh_.positions[a][axis], a) <
                              std::pair(mesh_.positions[b][axis], b);
                     });
    find(near, vertices.first(middle));
    find(near, vertices.subspan(middle));
  }

  std::vector<OnSide> take() { return std::move(found_); }

 private:
  bool meets(const Border& border, const Box& box) const {
    Box own;
    own.add(mesh_.positions[border.a]);
    own.add(mesh_.positions[border.b]);
    return glm::all(glm::lessThanEqual(own.low - tolerance_, box.high)) &&
           glm::all(glm::lessThanEqual(box.low, own.high + tolerance_));
  }

  void test(const Border& border, std::uint32_t vertex) {
    const uvec3 own = mesh_.faces[border.face].vertices;
    if (vertex == own.x || vertex == own.y || vertex == own.z) return;
    const glm::dvec3 a = mesh_.positions[border.a];
    const glm::dvec3 edge = mesh_.positions[border.b] - a, way = mesh_.positions[vertex] - a;
    const double length = glm::length(edge), along = glm::dot(way, edge) / (length * length);
    const double from_ends = length * std::min(along, 1.0 - along);
    const double height = glm::length(mesh_.area_vector(border.face)) / length;
    if (from_ends < kClear * tolerance_ || height < kClear * tolerance_ ||
        glm::length(way - along * edge) > tolerance_) {
      return;
    }
    found_.push_back({border.face, border.side, along, vertex});
  }

  const PatchMesh& mesh_;
  double tolerance_;
  std::vector<OnSide> found_;
};

/// A face with the vertices on each of its sides, in order from corner to corner.
struct Cut {
  PatchMesh::Face face;
  std::array<std::vector<std::pair<double, std::uint32_t>>, 3> on_side;  // how far along

  /// The half that has corner `side` and, from the vertex on that side, goes to the corner
  /// opposite; or the other half.
  Cut half(std::size_t side, std::size_t at, bool first) const {
    const std::size_t next = (side + 1) % 3, last = (side + 2) % 3;
    const auto [along, vertex] = on_side[side][at];
    const std::size_t moved = first ? next : side;
    Cut result = *this;
    result.face.vertices[static_cast<int>(moved)] = vertex;
    result.face.places[moved] = face.places[side] * (1.0 - along) + face.places[next] * along;
    auto& rest = result.on_side[side];
    if (first) {
      rest.resize(at);
      for (auto& [t, v] : rest) t /= along;
      result.on_side[next].clear();  // the cut
    } else {
      rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(at) + 1);
      for (auto& [t, v] : rest) t = (t - along) / (1.0 - along);
      result.on_side[last].clear();
    }
    return result;
  }
};

/// Cuts from the vertex next to the middle of a side until none is on any side.
void triangulate(Cut whole, std::vector<PatchMesh::Face>& faces) {
  std::vector<Cut> open{std::move(whole)};
  while (!open.empty()) {
    const Cut cut = std::move(open.back());
    open.pop_back();
    std::size_t side = 0;
    while (side < 3 && cut.on_side[side].empty()) ++side;
    if (side == 3) {
      faces.push_back(cut.face);
      continue;
    }
    const auto& points = cut.on_side[side];
    const auto from_middle = [](const auto& p) { return std::abs(p.first - 0.5); };
    const auto best =
        static_cast<std::size_t>(std::min_element(points.begin(), points.end(),
                                                  [&](const auto& a, const auto& b) {
                                                    return from_middle(a) < from_middle(b);
                                                  }) -
                                 points.begin());
    open.push_back(cut.half(side, best, false));
    open.push_back(cut.half(side, best, true));
  }
}

}  // namespace

void close_t_junctions(PatchMesh& mesh, double tolerance) {
  const std::vector<Border> borders = borders_of(mesh);
  std::vector<std::uint32_t> vertices;
  for (const Border& border : borders) vertices.insert(vertices.end(), {border.a, border.b});
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  Finder finder(mesh, tolerance);
  finder.find(borders, vertices);
  std::vector<OnSide> found = finder.take();
  if (found.empty()) return;
  std::sort(found.begin(), found.end(), [](const OnSide& a, const OnSide& b) {
    return std::tuple(a.face, a.side, a.along, a.vertex) <
           std::tuple(b.face, b.side, b.along, b.vertex);
  });
  std::vector<PatchMesh::Face> faces;
  std::size_t next = 0;
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    Cut cut{mesh.faces[f], {}};
    for (; next < found.size() && found[next].face == f; ++next) {
      auto& points = cut.on_side[static_cast<std::size_t>(found[next].side)];
      points.emplace_back(found[next].along, found[next].vertex);
    }
    triangulate(std::move(cut), faces);
  }
  mesh.faces = std::move(faces);
}

}  // namespace lantern
