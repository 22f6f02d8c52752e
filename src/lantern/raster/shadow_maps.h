// SPDX-License-Identifier: MIT
// The triangles that lights see, as maps of their numbers: half an octahedron for a light that
// shines to one side, a whole one for a point, a parallel picture from infinity. Shaders meet rays
// with those triangles. Maps are kept while the lights stay. [Lecocq et al. 2014]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/clusters.h"
#include "lantern/raster/map_faces.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/stage_times.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <span>
#include <vector>

namespace lantern {

struct ShadowMapOptions {
  int size = 256;                    // texels a side of an octahedron, even
  std::size_t bytes = 256ull << 20;  // that maps may take; the group in use always has its own
  ClipRange range = ClipRange::kFarIs0;
};

class ShadowMaps {
 public:
  ShadowMaps(const World& world, const gl::ShaderFiles& files, const ShadowMapOptions& options);

  /// Forgets the maps of all lights but these.
  void keep(std::span<const LightGroup> groups);
  /// Draws the group's maps unless they are there still.
  void draw(const LightGroup& group, StageTimes& times);
  /// The maps of the group that was drawn last, on two texture units from `unit` on.
  void set_in(const gl::Program& program, int unit);

  /// What a program with shaders/shadow_maps.glsl is made with, and what it then needs once.
  gl::Definition definition() const;
  static void prepare(const gl::Program& program);

  /// Lights whose maps were drawn so far.
  std::size_t drawn() const { return drawn_; }

 private:
  struct Maps {
    LightFormula formula;
    std::vector<MapFrame> frames;
    gl::Texture texels;
  };

  /// What maps are drawn into first.
  struct Unfinished {
    gl::Texture texels, depth;
    gl::Framebuffer framebuffer;
    Unfinished(int width, int height);
  };

  bool are_of(const Maps& maps, const LightGroup& group) const;
  void make_room(std::size_t bytes);
  void draw(const Maps& maps);
  void draw_light(const Maps& maps, std::size_t light);

  Bounds bounds_;
  ShadowMapOptions options_;
  gl::Program triangles_program_, blocks_program_;
  std::vector<std::uint32_t> order_;  // of the world's triangles
  std::vector<Cluster> clusters_;     // of that order
  gl::Buffer positions_, numbers_, indices_, frames_;
  gl::VertexArray array_;
  gl::Texture triangles_;
  std::map<int, Unfinished> unfinished_;  // by height
  gl::VertexArray no_vertices_;
  std::list<Maps> kept_;  // the one that was used last is the last
  std::size_t drawn_ = 0;
};

}  // namespace lantern
