// SPDX-License-Identifier: MIT
#include "lantern/radiosity/interpolation.h"

#include "lantern/core/parallel.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace lantern {
namespace {

constexpr std::size_t kGrain = 256;

/// Which patches stand around each smooth vertex.
class Rings {
 public:
  explicit Rings(const Patches& patches) : first_(patches.smooth_vertex_count + 1, 0) {
    for (const uvec3& v : patches.smooth_vertices) {
      for (int k = 0; k < 3; ++k) ++first_[v[k] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    patches_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      for (int k = 0; k < 3; ++k) patches_[next[patches.smooth_vertices[i][k]]++] = i;
    }
  }
  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return std::span(patches_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }

 private:
  std::vector<std::uint32_t> first_, patches_;
};

/// Where values of patches are carried to.
struct Target {
  glm::dvec3 position;
  bool front;
};

/// The plane through the values around a vertex, at the vertex.
glm::dvec3 fit(const Patches& patches, std::span<const glm::dvec3> values,
               std::span<const std::uint32_t> around, const Target& target) {
  double weights = 0.0;
  glm::dvec3 mean_value(0.0), mean_place(0.0);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(0.0);
  const auto for_each = [&](auto&& visit) {
    for (const std::uint32_t patch : around) {
      const std::uint32_t e = patches.element_at(patch, target.front);
      if (e != kNoElement && patches.exposed[e] > 0.0) visit(patch, e, patches.exposed_area(e));
    }
  };
  for_each([&](std::uint32_t patch, std::uint32_t e, double weight) {
    weights += weight;
    mean_value += weight * values[e];
    mean_place += weight * (patches.centre[patch] - target.position);
    low = glm::min(low, values[e]);
    high = glm::max(high, values[e]);
  });
  if (weights == 0.0) return glm::dvec3(0.0);
  mean_value /= weights;
  mean_place /= weights;

  glm::dmat3 spread(0.0), against(0.0);  // of places; of values (columns: channels) and places
  for_each([&](std::uint32_t patch, std::uint32_t e, double weight) {
    const glm::dvec3 place = patches.centre[patch] - target.position - mean_place;
    spread += weight * glm::outerProduct(place, place);
    against += weight * glm::outerProduct(place, values[e] - mean_value);
  });
  // The places lie in a plane or, of one or two patches, on a line: across it there is no gradient.
  constexpr double kRidge = 1e-6;
  const double ridge = kRidge * (spread[0][0] + spread[1][1] + spread[2][2]);
  if (!(ridge > 0.0)) return mean_value;
  const glm::dmat3 gradient = glm::inverse(spread + glm::dmat3(ridge)) * against;
  const glm::dvec3 slack = high - low;
  return glm::clamp(mean_value - glm::transpose(gradient) * mean_place, glm::max(low - slack, 0.0),
                    high + slack);
}

/// Moves the values at the vertices so that their means over the patches come nearer to `values`:
/// each vertex by the mean of what the patches around it lack. Over all patches of a surface
/// nothing is lacking then, whatever the fit lost at shadow edges and in bends.
void restore_means(const Patches& patches, std::span<const glm::dvec3> values, const Rings& rings,
                   bool front, std::vector<glm::dvec3>& at) {
  std::vector<glm::dvec3> lacking(patches.size(), glm::dvec3(0.0));
  std::vector<double> weight(patches.size(), 0.0);
  parallel_for(patches.size(), kGrain, [&](std::size_t i) {
    const std::uint32_t e = patches.element_at(static_cast<std::uint32_t>(i), front);
    if (e == kNoElement) return;
    const uvec3 v = patches.smooth_vertices[i];
    weight[i] = patches.exposed_area(e);
    lacking[i] = values[e] - (at[v.x] + at[v.y] + at[v.z]) / 3.0;
  });
  parallel_for(at.size(), kGrain, [&](std::size_t v) {
    double weights = 0.0;
    glm::dvec3 sum(0.0);
    for (const std::uint32_t patch : rings.around(static_cast<std::uint32_t>(v))) {
      weights += weight[patch];
      sum += weight[patch] * lacking[patch];
    }
    if (weights > 0.0) at[v] = glm::max(at[v] + sum / weights, 0.0);
  });
}

}  // namespace

VertexValues interpolate_to_vertices(const Patches& patches, std::span<const glm::dvec3> values) {
  assert(values.size() == patches.elements());
  // A plane takes three patches; where fewer meet, at a corner, those behind them help.
  constexpr std::size_t kEnough = 4;
  const Rings rings(patches);
  std::vector<glm::dvec3> places(patches.smooth_vertex_count);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      places[patches.smooth_vertices[i][k]] = patches.mesh.corner(i, k);
    }
  }
  VertexValues result;
  result.front.resize(places.size());
  result.back.resize(places.size());
  parallel_for(places.size(), kGrain, [&](std::size_t v) {
    std::span<const std::uint32_t> around = rings.around(static_cast<std::uint32_t>(v));
    std::vector<std::uint32_t> wider;
    if (around.size() < kEnough) {
      for (const std::uint32_t patch : around) {
        for (int k = 0; k < 3; ++k) {
          const auto more = rings.around(patches.smooth_vertices[patch][k]);
          wider.insert(wider.end(), more.begin(), more.end());
        }
      }
      std::sort(wider.begin(), wider.end());
      wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
      around = wider;
    }
    result.front[v] = fit(patches, values, around, {places[v], true});
    result.back[v] = fit(patches, values, around, {places[v], false});
  });
  // The first restores the mean of each surface, the others what is left in single patches; more
  // only sharpen grain.
  constexpr int kRestorations = 3;
  for (int i = 0; i < kRestorations; ++i) {
    restore_means(patches, values, rings, true, result.front);
    restore_means(patches, values, rings, false, result.back);
  }
  return result;
}

}  // namespace lantern
