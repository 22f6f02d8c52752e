// SPDX-License-Identifier: MIT
#include "lantern/raster/bodies.h"

#include "lantern/raster/neighbours.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace lantern {
namespace {

/// Fewer triangles are drawn sooner than a call of their own is made.
constexpr std::uint32_t kFewest = 64;

bool share_edge(const World& world, std::uint32_t a, int corner, std::uint32_t b, int other) {
  const auto place = [&](std::uint32_t t, int i) {
    return world.positions[world.triangles[t][i % 3]];
  };
  return place(a, corner) == place(b, other + 1) && place(a, corner + 1) == place(b, other);
}

/// Whether two triangles meet in each edge, with their fronts on the same side.
bool is_closed(const World& world, std::span<const std::array<std::uint32_t, 3>> neighbours,
               std::span<const std::uint32_t> part) {
  return std::all_of(part.begin(), part.end(), [&](std::uint32_t t) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t next = neighbours[t][static_cast<std::size_t>(corner)];
      if (next == kNoTriangle) return false;
      bool is_mutual = false;
      for (int i = 0; i < 3; ++i) {
        is_mutual |= neighbours[next][static_cast<std::size_t>(i)] == t &&
                     share_edge(world, t, corner, next, i);
      }
      if (!is_mutual) return false;
    }
    return true;
  });
}

/// The outer side of the triangles of a closed part, if it is convex.
SeenSide outer_side(const World& world, std::span<const std::uint32_t> part) {
  // Each of its planes is compared with all of its vertices.
  constexpr std::size_t kMostComparisons = 1u << 22;
  std::vector<Vec3> places;
  for (const std::uint32_t t : part) {
    for (int corner = 0; corner < 3; ++corner) {
      places.push_back(world.positions[world.triangles[t][corner]]);
    }
  }
  std::sort(places.begin(), places.end(), [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  places.erase(std::unique(places.begin(), places.end()), places.end());
  if (part.size() * places.size() > kMostComparisons) return SeenSide::kBoth;

  // Planes are as exact as shadow rays start off surfaces.
  const float rounding = 0x1p-18f * world.coordinate_scale();
  bool front = true, back = true;
  for (const std::uint32_t t : part) {
    const Vec3 area = world.area_vector(t);
    if (!has_area(area)) continue;
    const Vec3 normal = glm::normalize(area);
    const float offset = glm::dot(normal, world.positions[world.triangles[t].x]);
    for (const Vec3& place : places) {
      const float height = glm::dot(normal, place) - offset;
      front &= height <= rounding;
      back &= height >= -rounding;
    }
    if (!front && !back) return SeenSide::kBoth;
  }
  return front ? SeenSide::kFront : SeenSide::kBack;
}

}  // namespace

Parts find_parts(std::span<const std::array<std::uint32_t, 3>> neighbours) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  Parts parts{std::vector<std::uint32_t>(neighbours.size(), kNone), {}};
  std::vector<std::uint32_t> open;
  const auto take = [&](std::uint32_t triangle) {
    parts.of_triangle[triangle] = static_cast<std::uint32_t>(parts.sizes.size() - 1);
    ++parts.sizes.back();
    open.push_back(triangle);
  };
  for (std::uint32_t seed = 0; seed < neighbours.size(); ++seed) {
    if (parts.of_triangle[seed] != kNone) continue;
    parts.sizes.push_back(0);
    take(seed);
    while (!open.empty()) {
      const std::uint32_t triangle = open.back();
      open.pop_back();
      for (const std::uint32_t next : neighbours[triangle]) {
        if (next != kNoTriangle && parts.of_triangle[next] == kNone) take(next);
      }
    }
  }
  return parts;
}

std::vector<Body> make_bodies(const World& world,
                              std::span<const std::array<std::uint32_t, 3>> neighbours,
                              const Parts& parts, std::span<std::uint32_t> triangles,
                              std::uint32_t before) {
  constexpr std::uint32_t kTogether = std::numeric_limits<std::uint32_t>::max();
  const auto key = [&](std::uint32_t t) {
    const std::uint32_t part = parts.of_triangle[t];
    return parts.sizes[part] < kFewest ? kTogether : part;
  };
  std::stable_sort(triangles.begin(), triangles.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<Body> bodies;
  for (std::size_t first = 0; first < triangles.size();) {
    std::size_t end = first;
    Bounds box;
    for (; end < triangles.size() && key(triangles[end]) == key(triangles[first]); ++end) {
      for (int corner = 0; corner < 3; ++corner) {
        box.add(world.positions[world.triangles[triangles[end]][corner]]);
      }
    }
    const auto run = triangles.subspan(first, end - first);
    const std::uint32_t part = key(run[0]);
    const bool is_whole = part != kTogether && run.size() == parts.sizes[part];
    bodies.push_back(
        {before + static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(run.size()),
         box.centre(), box.radius(),
         is_whole && is_closed(world, neighbours, run) ? outer_side(world, run) : SeenSide::kBoth});
    first = end;
  }
  return bodies;
}

bool may_lie_inside(const Body& body, std::span<const Vec4> planes) {
  return std::all_of(planes.begin(), planes.end(), [&](const Vec4& plane) {
    return glm::dot(Vec3(plane), body.centre) + plane.w >= -body.radius;
  });
}

SeenSide seen_side(const Body& body, const Vec3& from) {
  const Vec3 way = from - body.centre;
  return glm::dot(way, way) > body.radius * body.radius ? body.outside : SeenSide::kBoth;
}

}  // namespace lantern
