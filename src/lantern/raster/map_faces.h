// SPDX-License-Identifier: MIT
// How lights unfold into shadow maps (see shaders/shadow_map.glsl): the pictures a map is made of,
// each a linear map of space, and what lies in each. No GL in it.
#pragma once

#include "lantern/core/math.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/view.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

/// As `LightMap` in shaders/shadow_maps.glsl has it; the fourth column of a light that has a
/// position is that. Where it shines to one side x and y are sqrt(2) long and z is its axis.
struct MapFrame {
  Vec4 x{0.0f}, y{0.0f}, z{0.0f};
  bool operator==(const MapFrame&) const = default;
};

/// What maps are of: all that casts shadows, and where the points are that ask.
struct MapBounds {
  Bounds scene, receivers;
};

/// Texels a side of a point light's map, an octahedron, where there are so many casters.
int octahedron_size(std::size_t casters);
/// Those of other lights' maps beside such octahedra.
int map_size(LightFormula formula, int octahedron);

/// What a texel of a map takes: two numbers, what a block sees and, in half as many texels again,
/// windows.
inline constexpr std::size_t kMapTexelBytes = 5 * sizeof(std::uint32_t);
/// What maps that are kept may take together.
inline constexpr std::size_t kMapBytes = 1280ull << 20;

/// Of each light of the group; maps have `size` texels a side.
std::vector<MapFrame> map_frames(const LightGroup& group, const MapBounds& bounds, int size);

/// A box around `receivers` of a grid of the scene, so that most views of a place share one.
Bounds snapped(const Bounds& receivers, const Bounds& scene);

/// Whether maps of the box `kept` do for `wanted`, both snapped: it is inside and not much smaller.
bool still_fits(const Bounds& kept, const Bounds& wanted, const Bounds& scene);

/// A part of a map that is one picture.
struct MapFace {
  int x = 0, y = 0, width = 0, height = 0;  // of the map
  // Drawn where the dot products with (2 x - size, 2 y - size, size) are not negative.
  std::array<Vec3, 2> edges{Vec3(0.0f), Vec3(0.0f)};
  Vec3 origin{0.0f};
  Mat4 clip{1.0f};           // of positions relative to the origin
  Vec3 depth{0.0f};          // the map's depth is the dot product of such a position with this
  std::vector<Vec4> planes;  // of such positions; it sees what lies on their positive side
};

/// Those of one light.
std::vector<MapFace> map_faces(const MapFrame& frame, LightFormula formula, const Bounds& bounds,
                               int size, ClipRange range);

}  // namespace lantern
