// SPDX-License-Identifier: MIT
// Adds up what lights give to the pixels that see them, 32 lights at a time, in 32-bit floats.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/map_tiles.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/surfaces.h"

#include <array>
#include <vector>

namespace lantern {

/// What says which lights a pixel sees; both must say so, where there are both.
struct SeenBy {
  const gl::Texture* mask = nullptr;  // bit i (RGBA8, the lowest byte in red): light i
  const MapTiles* maps = nullptr;     // that were asked for these lights
};

/// Which of these there are.
enum class Witnesses { kMask, kMaps, kBoth };

class MaskedShading {
 public:
  /// Of pictures of this size.
  MaskedShading(const gl::ShaderFiles& files, int width, int height, Witnesses witnesses);

  /// No light.
  void clear() { sums_[0].clear(); }
  /// And what the lights give that the witnesses see; before the first of them there is none.
  void add(const LightGroup& group, const GBuffer& g_buffer, const SeenBy& seen, bool is_first);
  /// In W/m².
  const QuadTarget& irradiance() const { return sums_[0]; }

  /// Of the QuadLayout.
  static constexpr int kTile = MapTiles::kTile;

 private:
  Witnesses witnesses_;
  std::vector<gl::Program> shade_;  // by formula
  gl::Buffer lights_;
  std::array<QuadTarget, 2> sums_;  // what there is, and that with a group of lights more
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
