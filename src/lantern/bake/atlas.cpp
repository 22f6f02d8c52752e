// SPDX-License-Identifier: MIT
#include "lantern/bake/atlas.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace lantern {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Cosine of about a degree, as smooth vertices take it: what differs less is flat. Laying it down
/// shortens it by less than the cosine's difference from 1.
constexpr double kSamePlane = 0.99985;

constexpr std::uint32_t kNone = kNoElement;

/// One side of a patch's edge: its vertices in the order in which the front goes round.
struct Side {
  std::uint32_t low, high;
  std::uint32_t patch;
  int edge;      // from corner `edge` to the next
  bool forward;  // from low to high
};

/// For each patch and edge the patch beyond it that goes on in one surface of one material.
std::vector<std::array<std::uint32_t, 3>> neighbours(const World& world, const Patches& patches) {
  std::vector<Side> sides;
  sides.reserve(3 * patches.size());
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    const uvec3 v = patches.mesh.faces[p].vertices;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = v[k], to = v[(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), p, k, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.patch) < std::tie(b.low, b.high, b.patch);
  });
  std::vector<std::array<std::uint32_t, 3>> result(patches.size(), {kNone, kNone, kNone});
  const auto material = [&](std::uint32_t p) {
    return world.materials[patches.mesh.faces[p].source];
  };
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low &&
           sides[end].high == sides[first].high) {
      ++end;
    }
    // Where more than two meet, nothing tells which goes on in which.
    if (end - first == 2) {
      const Side &a = sides[first], &b = sides[first + 1];
      if (a.forward != b.forward && material(a.patch) == material(b.patch)) {
        result[a.patch][static_cast<std::size_t>(a.edge)] = b.patch;
        result[b.patch][static_cast<std::size_t>(b.edge)] = a.patch;
      }
    }
    first = end;
  }
  return result;
}

/// A chart before it has its place: where its corners lie in metres, from (0, 0) on.
struct Flat {
  std::vector<std::uint32_t> elements;
  std::vector<std::array<dvec2, 3>> corners;
  dvec2 extent{0.0};
};

struct Edge {
  dvec2 along;
  double length;
};

/// The direction among those of the longest outer edges along which the bounding box is smallest,
/// lying rather than standing.
dvec2 best_direction(const Flat& flat, std::vector<Edge> outer) {
  constexpr std::size_t kTried = 16;
  std::stable_sort(outer.begin(), outer.end(),
                   [](const Edge& a, const Edge& b) { return a.length > b.length; });
  if (outer.size() > kTried) outer.resize(kTried);
  dvec2 best(1.0, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : outer) {
    if (!(edge.length > 0.0)) continue;
    const dvec2 x = edge.along / edge.length, y(-x.y, x.x);
    dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& corners : flat.corners) {
      for (const dvec2& c : corners) {
        const dvec2 turned(glm::dot(c, x), glm::dot(c, y));
        low = glm::min(low, turned);
        high = glm::max(high, turned);
      }
    }
    const dvec2 extent = high - low;
    if (extent.x * extent.y < least) {
      least = extent.x * extent.y;
      best = extent.x >= extent.y ? x : y;
    }
  }
  return best;
}

/// Turned into its bounding box, which starts at (0, 0).
void lay_down(Flat& flat, const std::vector<Edge>& outer) {
  const dvec2 x = best_direction(flat, outer), y(-x.y, x.x);
  dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (auto& corners : flat.corners) {
    for (dvec2& c : corners) {
      c = {glm::dot(c, x), glm::dot(c, y)};
      low = glm::min(low, c);
      high = glm::max(high, c);
    }
  }
  for (auto& corners : flat.corners) {
    for (dvec2& c : corners) c -= low;
  }
  flat.extent = high - low;
}

/// Grows each chart from its first element, whose plane it keeps.
std::vector<Flat> make_flats(const World& world, const Patches& patches) {
  const auto next = neighbours(world, patches);
  std::vector<bool> taken(patches.elements(), false);
  std::vector<Flat> flats;
  for (std::uint32_t seed = 0; seed < patches.elements(); ++seed) {
    if (taken[seed]) continue;
    const bool front = patches.is_front(seed);
    const dvec3 normal = patches.element_normal(seed);
    const Frame frame{Vec3(normal)};
    const dvec3 across(frame.tangent), up = glm::cross(normal, across);
    const dvec3 origin = patches.mesh.corner(patches.patch[seed], 0);
    Flat flat;
    std::vector<Edge> outer;
    flat.elements.push_back(seed);
    taken[seed] = true;
    for (std::size_t i = 0; i < flat.elements.size(); ++i) {
      const std::uint32_t patch = patches.patch[flat.elements[i]];
      std::array<dvec2, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const dvec3 from_origin = patches.mesh.corner(patch, static_cast<int>(k)) - origin;
        corners[k] = {glm::dot(from_origin, across), glm::dot(from_origin, up)};
      }
      flat.corners.push_back(corners);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t beyond = next[patch][k];
        const std::uint32_t element = beyond == kNone ? kNone : patches.element_at(beyond, front);
        if (element == kNone || glm::dot(patches.element_normal(element), normal) < kSamePlane) {
          const dvec2 along = corners[(k + 1) % 3] - corners[k];
          outer.push_back({along, glm::length(along)});
        } else if (!taken[element]) {
          taken[element] = true;
          flat.elements.push_back(element);
        }
      }
    }
    lay_down(flat, outer);
    flats.push_back(std::move(flat));
  }
  return flats;
}

/// Texels from the first to the last that a length touches, when it starts at a texel's centre.
int texels(double length) { return static_cast<int>(std::ceil(length)) + 1; }

/// Rows of charts, the highest first. False where the picture is too small; `charts` is undefined
/// then.
bool pack(const std::vector<Flat>& flats, const std::vector<std::size_t>& highest_first, int size,
          double texels_per_metre, std::vector<Chart>& charts) {
  charts.assign(flats.size(), {});
  int x = 0, y = 0, row = 0;
  for (const std::size_t i : highest_first) {
    const dvec2 extent = flats[i].extent * texels_per_metre;
    if (extent.x > size || extent.y > size) return false;
    Chart& chart = charts[i];
    chart.width = texels(extent.x) + 2 * kChartBorder;
    chart.height = texels(extent.y) + 2 * kChartBorder;
    if (x + chart.width > size) {
      x = 0;
      y += row;
      row = 0;
    }
    if (chart.width > size || y + chart.height > size) return false;
    chart.x = x;
    chart.y = y;
    x += chart.width;
    row = std::max(row, chart.height);
  }
  return true;
}

/// The smallest power of two at which the borders leave room.
int smallest_size(const std::vector<Flat>& flats, const std::vector<std::size_t>& order) {
  std::vector<Chart> charts;
  int size = 1;
  while (!pack(flats, order, size, 0.0, charts)) size *= 2;
  return size;
}

}  // namespace

Atlas make_atlas(const World& world, const Patches& patches, int size) {
  const std::vector<Flat> flats = make_flats(world, patches);
  std::vector<std::size_t> order(flats.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return flats[a].extent.y > flats[b].extent.y;
  });

  Atlas atlas;
  atlas.size = size;
  if (!pack(flats, order, size, 0.0, atlas.charts)) {
    throw Error(fmt::format(
        "a lightmap of {0}x{0} texels has no room for the borders of {1} flat parts: it takes "
        "{2}x{2} at least",
        size, flats.size(), smallest_size(flats, order)));
  }
  // The largest scale that fits. No chart can be larger than the picture.
  double extent = 0.0;
  for (const Flat& flat : flats) extent = std::max({extent, flat.extent.x, flat.extent.y});
  double low = 0.0, high = static_cast<double>(size) / extent;
  constexpr int kHalvings = 24;  // to a share of 1e-7
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (pack(flats, order, size, middle, atlas.charts) ? low : high) = middle;
  }
  pack(flats, order, size, low, atlas.charts);
  atlas.texels_per_metre = low;

  atlas.chart.resize(patches.elements());
  atlas.corners.resize(patches.elements());
  for (std::size_t i = 0; i < flats.size(); ++i) {
    Chart& chart = atlas.charts[i];
    chart.elements = flats[i].elements;
    const dvec2 first(chart.x + kChartBorder + 0.5, chart.y + kChartBorder + 0.5);
    for (std::size_t j = 0; j < chart.elements.size(); ++j) {
      const std::uint32_t element = chart.elements[j];
      atlas.chart[element] = static_cast<std::uint32_t>(i);
      for (std::size_t k = 0; k < 3; ++k) {
        atlas.corners[element][k] = Vec2(first + low * flats[i].corners[j][k]);
      }
    }
  }
  return atlas;
}

}  // namespace lantern
