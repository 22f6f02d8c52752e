// SPDX-License-Identifier: MIT
// VirtualLights as the shaders read them: black ones left out, lifted off their surfaces, in groups
// of at most 32 of one kind, whose visibility is a mask of 32 bits.
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/edge_list.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lantern {

inline constexpr std::size_t kLightsInGroup = 32;

/// As `Light` in shaders/lights.glsl has it.
struct LightRecord {
  Vec4 place{0.0f}, axis{0.0f}, strength{0.0f};
};
static_assert(sizeof(LightRecord) == 48, "std140");

/// The formula that a light takes: KIND in shaders/lights.glsl.
enum class LightFormula { kSurface, kPunctual, kDirectional };
inline constexpr int kLightFormulas = 3;

struct LightGroup {
  LightFormula formula = LightFormula::kSurface;
  std::vector<LightRecord> records;
  std::vector<LightPoint> points;  // where shadow rays end
  // Of lights that shine to one side the planes with all that they shine on before them, length 1.
  std::vector<Vec4> fronts = {};
  // Where pixels have lights of their own: which pixel of a tile has these. Groups of one round
  // have one formula and are of different shares.
  std::size_t share = 0, round = 0;
};

/// `bounds` on the geometry term, one for each light, or none; `most` lights in a group.
std::vector<LightGroup> group_lights(const VirtualLights& lights, std::span<const float> bounds,
                                     float coordinate_scale, std::size_t most = kLightsInGroup);

}  // namespace lantern
