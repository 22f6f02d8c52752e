// SPDX-License-Identifier: MIT
#include "lantern/radiosity/patch_mesh.h"

#include "lantern/core/error.h"
#include "lantern/core/hash.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace lantern {
namespace {

struct SameBits {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) key = hash(key, std::bit_cast<std::uint32_t>(p[axis]));
    return key;
  }
};

constexpr std::uint32_t kNone = ~0u;

/// An edge is known by its two vertices, the lower first.
using EdgeKey = std::uint64_t;

EdgeKey edge_key(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<EdgeKey>(low) << 32) | high;
}

/// The edges of a mesh, each with the faces that meet there, be they one, two or more.
class Edges {
 public:
  explicit Edges(const PatchMesh& mesh) : of_face_(mesh.size()) {
    std::vector<std::pair<EdgeKey, std::uint32_t>> sides;  // 3 * face + corner that it starts at
    sides.reserve(3 * mesh.size());
    for (std::uint32_t f = 0; f < mesh.size(); ++f) {
      const uvec3 v = mesh.faces[f].vertices;
      for (std::uint32_t k = 0; k < 3; ++k) {
        sides.emplace_back(edge_key(v[static_cast<int>(k)], v[static_cast<int>((k + 1) % 3)]),
                           3 * f + k);
      }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (i == 0 || sides[i].first != sides[i - 1].first) {
        first_.push_back(static_cast<std::uint32_t>(i));
        keys_.push_back(sides[i].first);
        const glm::dvec3 along =
            mesh.positions[sides[i].first >> 32] - mesh.positions[sides[i].first & kNone];
        lengths_.push_back(glm::dot(along, along));
      }
      faces_.push_back(sides[i].second / 3);
      of_face_[sides[i].second / 3][sides[i].second % 3] =
          static_cast<std::uint32_t>(keys_.size() - 1);
    }
    first_.push_back(static_cast<std::uint32_t>(faces_.size()));
  }

  std::size_t size() const { return keys_.size(); }
  EdgeKey key(std::uint32_t edge) const { return keys_[edge]; }
  std::uint32_t of(std::size_t face, int corner) const {
    return of_face_[face][static_cast<std::size_t>(corner)];
  }
  std::span<const std::uint32_t> faces(std::uint32_t edge) const {
    return std::span(faces_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }
  /// The corner where the longest edge starts; among equals the same edge from either face.
  int longest(std::size_t face) const {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
      const std::uint32_t a = of(face, k), b = of(face, best);
      if (std::pair(lengths_[a], keys_[a]) > std::pair(lengths_[b], keys_[b])) best = k;
    }
    return best;
  }

 private:
  std::vector<EdgeKey> keys_;
  std::vector<double> lengths_;  // squared
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> faces_;
  std::vector<std::array<std::uint32_t, 3>> of_face_;
};

PatchMesh::Face rotated(const PatchMesh::Face& face, int by) {
  PatchMesh::Face result = face;
  for (int k = 0; k < 3; ++k) {
    const int from = (k + by) % 3;
    result.vertices[k] = face.vertices[from];
    result.places[static_cast<std::size_t>(k)] = face.places[static_cast<std::size_t>(from)];
  }
  return result;
}

/// The two halves of a face whose edge from corner 0 to corner 1 has `middle` on it.
std::pair<PatchMesh::Face, PatchMesh::Face> halves(const PatchMesh::Face& face,
                                                   std::uint32_t middle) {
  const glm::dvec2 place = 0.5 * (face.places[0] + face.places[1]);
  PatchMesh::Face first = face, second = face;
  first.vertices[1] = second.vertices[0] = middle;
  first.places[1] = second.places[0] = place;
  return {first, second};
}

bool may_cut(const PatchMesh& mesh, std::size_t face, const LeftAlone& alone) {
  return alone.empty() || !alone[mesh.faces[face].source];
}

std::vector<std::size_t> by_descending(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
}

/// Bisects the first `wanted` faces of `order`, fewer where that makes more than `count`. Returns
/// what bisect() does; nothing if not even one can be.
std::vector<std::uint32_t> bisect_within(PatchMesh& mesh, std::span<const std::size_t> order,
                                         std::size_t wanted, std::size_t count) {
  for (wanted = std::min(wanted, count - mesh.size()); wanted > 0; wanted /= 2) {
    std::vector<bool> marked(mesh.size(), false);
    for (const std::size_t face : order.subspan(0, wanted)) marked[face] = true;
    PatchMesh finer = mesh;
    std::vector<std::uint32_t> parents = bisect(finer, marked);
    if (finer.size() > count) continue;
    mesh = std::move(finer);
    return parents;
  }
  return {};
}

}  // namespace

glm::dvec3 PatchMesh::area_vector(std::size_t face) const {
  const glm::dvec3 a = corner(face, 0);
  return glm::cross(corner(face, 1) - a, corner(face, 2) - a);
}

double PatchMesh::longest_edge(std::size_t face) const {
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, glm::distance(corner(face, k), corner(face, (k + 1) % 3)));
  }
  return longest;
}

PatchMesh make_patch_mesh(const World& world) {
  PatchMesh mesh;
  std::unordered_map<Vec3, std::uint32_t, SameBits> known;
  std::vector<std::uint32_t> vertex(world.positions.size(), kNone);
  mesh.faces.reserve(world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    PatchMesh::Face face{.vertices = {}, .source = t, .places = {{{0, 0}, {1, 0}, {0, 1}}}};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = world.triangles[t][k];
      if (vertex[from] == kNone) {
        const Vec3 p = world.positions[from] + 0.0f;  // -0 and 0 are one place
        const auto next = static_cast<std::uint32_t>(mesh.positions.size());
        const auto [entry, is_new] = known.try_emplace(p, next);
        if (is_new) mesh.positions.emplace_back(p);
        vertex[from] = entry->second;
      }
      face.vertices[k] = vertex[from];
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

std::vector<std::uint32_t> bisect(PatchMesh& mesh, const std::vector<bool>& marked) {
  assert(marked.size() == mesh.size());
  const Edges edges(mesh);
  std::vector<std::uint32_t> middle(edges.size(), kNone);
  // Closure: a face with any edge to split has its longest split too.
  std::vector<std::size_t> pending;
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    if (marked[f]) pending.push_back(f);
  }
  while (!pending.empty()) {
    const std::size_t face = pending.back();
    pending.pop_back();
    const std::uint32_t edge = edges.of(face, edges.longest(face));
    if (middle[edge] != kNone) continue;
    middle[edge] = 0;  // numbered below, in the order of the edges
    for (const std::uint32_t f : edges.faces(edge)) pending.push_back(f);
  }
  for (std::uint32_t edge = 0; edge < edges.size(); ++edge) {
    if (middle[edge] == kNone) continue;
    middle[edge] = static_cast<std::uint32_t>(mesh.positions.size());
    const EdgeKey key = edges.key(edge);
    mesh.positions.push_back(0.5 * (mesh.positions[key >> 32] + mesh.positions[key & kNone]));
  }
  std::vector<PatchMesh::Face> faces;
  std::vector<std::uint32_t> parents;
  faces.reserve(mesh.size() * 2);
  parents.reserve(mesh.size() * 2);
  for (std::uint32_t f = 0; f < mesh.size(); ++f) {
    const int longest = edges.longest(f);
    const auto middle_of = [&](int side) { return middle[edges.of(f, (longest + side) % 3)]; };
    if (middle_of(0) == kNone) {
      faces.push_back(mesh.faces[f]);
      parents.push_back(f);
      continue;
    }
    const auto [first, second] = halves(rotated(mesh.faces[f], longest), middle_of(0));
    // In the first half the old third side runs from corner 2 to 0, in the second the old second
    // side from corner 1 to 2.
    for (const auto& [half, side, start] : {std::tuple(first, 2, 2), std::tuple(second, 1, 1)}) {
      if (middle_of(side) == kNone) {
        faces.push_back(half);
        continue;
      }
      const auto [a, b] = halves(rotated(half, start), middle_of(side));
      faces.push_back(a);
      faces.push_back(b);
    }
    parents.resize(faces.size(), f);
  }
  mesh.faces = std::move(faces);
  return parents;
}

void refine_to_size(PatchMesh& mesh, double size, std::size_t most, const LeftAlone& alone) {
  assert(size > 0.0);
  while (true) {
    std::vector<bool> marked(mesh.size());
    bool any = false;
    for (std::size_t f = 0; f < mesh.size(); ++f) {
      marked[f] = mesh.longest_edge(f) > size && may_cut(mesh, f, alone);
      any = any || marked[f];
    }
    if (!any) return;
    bisect(mesh, marked);
    if (mesh.size() > most) {
      throw Error(fmt::format(
          "patches of {:.4g} m are more than {} in this scene; take larger ones", size, most));
    }
  }
}

void refine_to_count(PatchMesh& mesh, std::size_t count, const LeftAlone& alone) {
  // Edges within a quarter of an octave are split together: few rounds, yet even sizes.
  constexpr double kTogether = 0.84089641525371454;
  while (mesh.size() > 0 && mesh.size() < count) {
    std::vector<double> edges(mesh.size());
    for (std::size_t f = 0; f < mesh.size(); ++f) {
      edges[f] = may_cut(mesh, f, alone) ? mesh.longest_edge(f) : 0.0;
    }
    const std::vector<std::size_t> order = by_descending(edges);
    if (edges[order.front()] == 0.0) return;
    const double least = kTogether * edges[order.front()];
    const auto wanted = static_cast<std::size_t>(
        std::find_if(order.begin(), order.end(), [&](std::size_t f) { return edges[f] < least; }) -
        order.begin());
    if (bisect_within(mesh, order, wanted, count).empty()) return;
  }
}

void refine_highest(PatchMesh& mesh, std::span<const double> scores, double decay,
                    std::size_t count) {
  assert(scores.size() == mesh.size());
  // So few at a time that the halves of the first come before the last.
  constexpr std::size_t kTogether = 16;
  std::vector<double> current(scores.begin(), scores.end());
  while (mesh.size() > 0 && mesh.size() < count) {
    const std::vector<std::size_t> order = by_descending(current);
    const std::size_t before = mesh.size();
    const std::vector<std::uint32_t> parents =
        bisect_within(mesh, order, std::max<std::size_t>(1, before / kTogether), count);
    if (parents.empty()) return;
    std::vector<std::uint32_t> parts(before, 0);
    for (const std::uint32_t parent : parents) ++parts[parent];
    std::vector<double> next;
    next.reserve(parents.size());
    for (const std::uint32_t parent : parents) {
      // A face is in one, two, three or four parts: halved no, once or twice.
      const int halved = parts[parent] == 1 ? 0 : parts[parent] == 2 ? 1 : 2;
      next.push_back(current[parent] * std::pow(decay, halved));
    }
    current = std::move(next);
  }
}

}  // namespace lantern
