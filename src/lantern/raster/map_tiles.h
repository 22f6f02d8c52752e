// SPDX-License-Identifier: MIT
// What shadow maps tell of tiles of pixels at once, for shaders that ask for the pixels of those of
// which that is nothing.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"

#include <optional>
#include <vector>

namespace lantern {

class MapTiles {
 public:
  /// Of views of this size. Keeps a reference to `maps`.
  MapTiles(ShadowMaps& maps, const gl::ShaderFiles& files, int width, int height);

  /// The points that are asked for next.
  void look_at(const GBuffer& g_buffer);
  /// For the lights of this group, in the view's part. Draws their maps where they are not there.
  void ask(const LightGroup& group, const View& view, StageTimes& times);
  /// What shaders/map_quads.glsl reads of that beside the points, on units from `unit` on.
  void set_in(const gl::Program& program, int unit) const;

  /// Pixels a side of a tile.
  static constexpr int kTile = 4;
  /// The part of a picture of tiles, of so many pixels a side, in which those of the view are.
  static View part_of(View view, int tile = kTile);

 private:
  struct Programs {
    gl::Program of_groups, of_tiles;
    Programs(const gl::ShaderFiles& files, LightFormula formula);
  };

  /// What is known of some tiles: what encloses them, and what maps told of them last.
  struct Tiles {
    gl::Texture spheres, normals, told;
    gl::Framebuffer framebuffer, told_framebuffer;
    Tiles(int width, int height);
  };

  Bounds bounds_of_tiles() const;
  void ask(const gl::Program& program, const Tiles& tiles, const View& part);

  ShadowMaps& maps_;
  gl::Program find_receivers_, find_tiles_, find_groups_;
  std::vector<Programs> programs_;  // by formula
  Tiles groups_, tiles_;
  gl::Texture receivers_;
  gl::Framebuffer receiver_framebuffer_;
  std::optional<Bounds> box_;  // around the points, once it is asked for
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
