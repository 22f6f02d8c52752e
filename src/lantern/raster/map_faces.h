// SPDX-License-Identifier: MIT
// How lights unfold into shadow maps (see shaders/shadow_map.glsl): the pictures a map is made of,
// each a linear map of space, and what lies in each. No GL in it.
#pragma once

#include "lantern/core/math.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/view.h"

#include <vector>

namespace lantern {

/// As `LightMap` in shaders/shadow_maps.glsl has it; the fourth column of a light that has a
/// position is that.
struct MapFrame {
  Vec4 x{0.0f}, y{0.0f}, z{0.0f};
  bool operator==(const MapFrame&) const = default;
};

/// What maps are of: all that casts shadows, and where the points are that ask.
struct MapBounds {
  Bounds scene, receivers;
};

/// Of each light of the group; maps have `size` texels a side.
std::vector<MapFrame> map_frames(const LightGroup& group, const MapBounds& bounds, int size);

/// A box around `receivers` of a grid of the scene, so that most views of a place share one.
Bounds snapped(const Bounds& receivers, const Bounds& scene);

/// Whether maps of the box `kept` do for `wanted`, both snapped: it is inside and not much smaller.
bool still_fits(const Bounds& kept, const Bounds& wanted, const Bounds& scene);

/// What of an octahedron belongs to a light.
enum class MapHalf { kWhole, kInside, kOutside };

/// Whose map a light draws into, and which half of it.
struct MapPlace {
  int tile;
  MapHalf half;
};
MapPlace map_place(LightFormula formula, std::size_t light);

/// A part of a map that is one picture.
struct MapFace {
  int x = 0, y = 0, size = 0;  // its square in the map
  int side = 0;                // 1: drawn inside the diamond alone, -1: outside, 0: everywhere
  Vec3 origin{0.0f};
  Mat4 clip{1.0f};           // of positions relative to the origin
  Vec3 depth{0.0f};          // the map's depth is the dot product of such a position with this
  std::vector<Vec4> planes;  // of such positions; it sees what lies on their positive side
};

/// Those of one light.
std::vector<MapFace> map_faces(const MapFrame& frame, LightFormula formula, MapHalf half,
                               const Bounds& bounds, int size, ClipRange range);

}  // namespace lantern
