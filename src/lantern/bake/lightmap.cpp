// SPDX-License-Identifier: MIT
#include "lantern/bake/lightmap.h"

#include "lantern/core/parallel.h"
#include "lantern/scene/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lantern {
namespace {

struct Nearest {
  float distance_squared = std::numeric_limits<float>::infinity();
  std::uint32_t element = kNoElement;
  Vec2 uv{0.0f};
};

float cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// The point of a triangle nearest to `p`, also of one that is only a line or a point.
Nearest nearest_in(const std::array<Vec2, 3>& corners, const Vec2& p) {
  const Vec2 b = corners[1] - corners[0], c = corners[2] - corners[0], to_p = p - corners[0];
  const float area = cross(b, c);
  if (area != 0.0f) {
    const Vec2 uv(cross(to_p, c) / area, cross(b, to_p) / area);
    if (uv.x >= 0.0f && uv.y >= 0.0f && uv.x + uv.y <= 1.0f) return {0.0f, kNoElement, uv};
  }
  static const std::array<Vec2, 3> kPlaces = {Vec2(0.0f), Vec2(1.0f, 0.0f), Vec2(0.0f, 1.0f)};
  Nearest best;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec2 edge = corners[next] - corners[k], offset = p - corners[k];
    const float length_squared = glm::dot(edge, edge);
    const float t = length_squared > 0.0f
                        ? std::clamp(glm::dot(offset, edge) / length_squared, 0.0f, 1.0f)
                        : 0.0f;
    const Vec2 away = offset - t * edge;
    const float distance_squared = glm::dot(away, away);
    if (distance_squared < best.distance_squared) {
      best = {distance_squared, kNoElement, glm::mix(kPlaces[k], kPlaces[next], t)};
    }
  }
  return best;
}

/// For each texel of a chart the nearest point of its patches, if one is within the border.
std::vector<Nearest> nearest_points(const Atlas& atlas, const Chart& chart) {
  std::vector<Nearest> nearest(static_cast<std::size_t>(chart.width) *
                               static_cast<std::size_t>(chart.height));
  constexpr float kReach = static_cast<float>(kChartBorder) + 0.5f;
  for (const std::uint32_t element : chart.elements) {
    const std::array<Vec2, 3>& corners = atlas.corners[element];
    const Vec2 origin(static_cast<float>(chart.x), static_cast<float>(chart.y));
    const Vec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]) - origin - kReach;
    const Vec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]) - origin + kReach;
    const int x0 = std::max(0, static_cast<int>(low.x)), y0 = std::max(0, static_cast<int>(low.y));
    const int x1 = std::min(chart.width - 1, static_cast<int>(high.x));
    const int y1 = std::min(chart.height - 1, static_cast<int>(high.y));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Vec2 centre = origin + Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f;
        Nearest found = nearest_in(corners, centre);
        Nearest& known = nearest[static_cast<std::size_t>(y * chart.width + x)];
        if (found.distance_squared >= known.distance_squared) continue;
        found.element = element;
        known = found;
      }
    }
  }
  return nearest;
}

}  // namespace

Lightmap make_lightmap(const Solution& solution, const Atlas& atlas) {
  Lightmap map;
  map.radiance = Image(atlas.size, atlas.size);
  map.coverage.assign(map.radiance.pixels.size(), 1.0f);
  const auto size = static_cast<std::size_t>(atlas.size);
  parallel_for(atlas.charts.size(), 1, [&](std::size_t i) {
    const Chart& chart = atlas.charts[i];
    const std::vector<Nearest> nearest = nearest_points(atlas, chart);
    for (int y = 0; y < chart.height; ++y) {
      for (int x = 0; x < chart.width; ++x) {
        const Nearest& at = nearest[static_cast<std::size_t>(y * chart.width + x)];
        if (at.element == kNoElement) continue;
        map.radiance.at(chart.x + x, chart.y + y) =
            solution.reflected(at.element, at.uv) + solution.emitted(at.element, at.uv);
        map.coverage[static_cast<std::size_t>(chart.y + y) * size +
                     static_cast<std::size_t>(chart.x + x)] =
            coverage_at(solution.scene(), solution.surfaces(), solution.patches().patch[at.element],
                        at.uv);
      }
    }
  });
  return map;
}

}  // namespace lantern
