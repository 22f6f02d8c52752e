// SPDX-License-Identifier: MIT
// The triangles that lights see, as maps of their numbers: half an octahedron for a light that
// shines to one side, a whole one for a point, a parallel picture from infinity. Shaders meet rays
// with those triangles. Maps are kept while the lights stay. [Lecocq et al. 2014]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/bodies.h"
#include "lantern/raster/clusters.h"
#include "lantern/raster/edge_list.h"
#include "lantern/raster/map_faces.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/triangle_texture.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lantern {

enum class MapCasters { kSolid, kWithHoles };  // by the material's has_holes()

struct ShadowMapOptions {
  // Texels a side of an octahedron, a multiple of 128; half of one has three quarters of them, what
  // is seen from infinity a size of its own. None: as the number of casters asks for.
  std::optional<int> size = std::nullopt;
  std::size_t bytes = kMapBytes;  // that maps may take; the group in use always has its own
  ClipRange range = ClipRange::kFarIs0;
  MapCasters casters = MapCasters::kSolid;
};

class ShadowMaps {
 public:
  /// Keeps a reference to `surfaces`, which were made of these.
  ShadowMaps(const Scene& scene, const World& world, const Surfaces& surfaces,
             const gl::ShaderFiles& files, const ShadowMapOptions& options);

  /// Forgets the maps of all lights but these.
  void keep(std::span<const LightGroup> groups);
  /// Draws the group's maps unless they are there still. Those from infinity show the box of a grid
  /// around the points that will ask, `receivers`.
  void draw(const LightGroup& group, const Bounds& receivers, StageTimes& times);
  /// What shaders/shadow_maps.glsl takes of the group that was drawn last.
  void set_in(const gl::Program& program, int unit) const;
  /// What its blocks and windows see (see shaders/shadow_map.glsl), and the numbers of the
  /// triangles that texels see.
  const gl::Texture& blocks() const { return kept_.back().blocks; }
  const gl::Texture& numbers() const { return kept_.back().numbers; }
  const TriangleTextures& triangles() const { return triangles_; }

  /// Lights whose maps were drawn so far.
  std::size_t drawn() const { return drawn_; }

 private:
  struct Maps {
    LightFormula formula;
    std::vector<LightRecord> lights;
    std::vector<LightPoint> points;
    Bounds receivers;
    std::vector<MapFrame> frames;
    gl::Texture frame_texels, blocks, numbers;
    std::size_t bytes() const;
  };

  /// What a map is drawn into first: what texels see and, apart, edges before that or what stands
  /// behind veils.
  struct Unfinished {
    gl::Texture texels, others, depth;
    gl::Framebuffer framebuffer, framebuffer_of_others;
    explicit Unfinished(int size);
  };

  /// Casters that are drawn with the same uniforms or left out together: the solid ones, those in a
  /// wall, or those of a material.
  struct Batch {
    std::optional<std::size_t> material_with_holes;
    bool is_veil = false;           // see even_coverage()
    std::optional<Vec4> wall;       // nothing in it is between two points on its positive side
    std::vector<Cluster> clusters;  // of the order of all casters
    std::vector<float> widths;      // of each cluster's most slender patch
  };
  struct Casters {
    std::vector<std::uint32_t> order;  // of the world's triangles
    std::vector<Batch> batches;
    std::vector<Body> bodies;
    std::vector<std::uint32_t> body_of;  // each caster
    std::vector<Vec4> planes;  // of each caster, length 1, the outside of its body before it
  };
  /// What is drawn of a light: for each batch and face a run of the indices.
  struct Drawn {
    GLenum mode;
    std::vector<MapFace> faces;
    std::vector<std::uint32_t> indices = {};
    std::vector<std::size_t> ends = {};
    const gl::Texture* before = nullptr;  // only what is behind the triangles that these texels see
  };
  static Casters casters_of(const Scene& scene, const World& world, MapCasters which);
  void find_widths(const World& world);
  void find_bodies(const Scene& scene, const World& world);
  /// Whether all of the cluster is on the far sides of closed convex bodies, which hide it.
  bool is_turned_away(const Cluster& cluster, const LightPoint& light) const;

  int size_of(LightFormula formula) const;
  static bool are_of(const Maps& maps, const LightGroup& group);
  void make_room(std::size_t bytes);
  void draw(const Maps& maps);
  void draw_windows(const Maps& maps);
  void draw_light(const Maps& maps, std::size_t light, const Unfinished& unfinished);
  void draw_batches(const Maps& maps, std::size_t light, const Drawn& drawn);

  TriangleTextures triangles_;
  Bounds bounds_;
  ShadowMapOptions options_;
  const Surfaces& surfaces_;
  gl::Program solid_, with_holes_, blocks_, windows_;
  Casters casters_;
  int size_;
  std::vector<gl::Buffer> attributes_;
  gl::Buffer indices_;
  gl::VertexArray array_;
  std::map<int, Unfinished> unfinished_;  // by size
  gl::VertexArray no_vertices_;
  std::list<Maps> kept_;  // the one that was used last is the last
  std::size_t drawn_ = 0;
};

}  // namespace lantern
