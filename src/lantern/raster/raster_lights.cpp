// SPDX-License-Identifier: MIT
#include "lantern/raster/raster_lights.h"

#include "lantern/trace/tracer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace lantern {
namespace {

/// Infinite is a number to compare with on the CPU; GLSL promises none.
float finite(float bound) { return std::min(bound, std::numeric_limits<float>::max()); }

}  // namespace

std::vector<LightGroup> group_lights(const VirtualLights& lights, std::span<const float> bounds,
                                     float coordinate_scale, std::size_t most) {
  assert(most <= kLightsInGroup);
  assert(bounds.empty() || bounds.size() == lights.size());
  std::vector<LightGroup> groups;
  std::array<std::size_t, kLightFormulas> open;  // the group of each formula that is not full
  open.fill(std::numeric_limits<std::size_t>::max());
  const auto add = [&](LightFormula formula, const LightRecord& record, const LightPoint& point) {
    std::size_t& group = open[static_cast<std::size_t>(formula)];
    if (group >= groups.size() || groups[group].records.size() == most) {
      group = groups.size();
      groups.push_back({.formula = formula, .records = {}, .points = {}});
    }
    groups[group].records.push_back(record);
    groups[group].points.push_back(point);
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Rgb flux = lights.flux[i];
    if (is_black(flux)) continue;
    const Vec3 position = lights.position[i], normal = lights.normal[i];
    switch (lights.kind[i]) {
      case LightKind::kSurface: {
        const Vec3 lifted = off_surface(position, normal, coordinate_scale);
        const float bound = finite(bounds.empty() ? kInfinity : bounds[i]);
        add(LightFormula::kSurface,
            {Vec4(lifted, bound), Vec4(normal, 0.0f), Vec4(flux * kInvPi, 0.0f)},
            Vec4(lifted, 1.0f));
        groups[open[static_cast<std::size_t>(LightFormula::kSurface)]].fronts.emplace_back(
            normal, -glm::dot(normal, lifted));
        break;
      }
      case LightKind::kPoint:
        add(LightFormula::kPunctual,
            {Vec4(position, -2.0f), Vec4(normal, -3.0f), Vec4(flux / (4.0f * kPi), 0.0f)},
            Vec4(position, 1.0f));
        break;
      case LightKind::kSpot: {
        const Vec2 cone = lights.cone[i];
        add(LightFormula::kPunctual,
            {Vec4(position, cone.x), Vec4(normal, cone.y),
             Vec4(flux / spot_solid_angle(cone), 0.0f)},
            Vec4(position, 1.0f));
        break;
      }
      case LightKind::kDirectional:
        add(LightFormula::kDirectional, {Vec4(normal, 0.0f), Vec4(0.0f), Vec4(flux, 0.0f)},
            Vec4(-normal, 0.0f));
        break;
    }
  }
  return groups;
}

}  // namespace lantern
