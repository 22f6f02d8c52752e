// SPDX-License-Identifier: MIT
// The triangles of a World -> the quads of their shadow volumes for a light, for any polygon soup.
// Every triangle's shadow is a volume of its own; an edge is extruded as often as its triangles'
// volumes do not cancel there, so that the count at a point is that of the triangles before the
// light. [Crow 1977; open and non-manifold meshes: Bergeron 1986; Aldridge & Woods 2004]
#pragma once

#include "lantern/raster/eye_line.h"
#include "lantern/raster/volume_edge.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lantern {

/// Planes that all of the scene lies in front of and that some of its triangles lie in, largest
/// first: (unit normal, offset) with dot(normal, p) + offset >= 0 on the inside, but for a rounding
/// of the scene's largest coordinate. What is in them stands between no two points inside.
std::vector<Vec4> find_walls(const World& world);

/// Whether the point lies on the inner side of all walls.
bool is_inside(std::span<const Vec4> walls, const LightPoint& point);

/// The first wall that the triangle lies in.
std::optional<std::size_t> wall_of(const World& world, std::uint32_t triangle,
                                   std::span<const Vec4> walls);

struct ShadowVolumes {
  std::vector<VolumeEdge> edges;  // an edge that is extruded n times stands here n times
  int eye_count = 0;              // of the volumes around the eye
  bool dark = false;              // no point that is seen is lit
};

/// kPlain counts triangles. Where every edge of a part of the scene has an even number of them all
/// points that are seen have a count of the same parity; kHalved counts pairs there, which draws a
/// closed mesh's silhouette once instead of twice. A count is 0 where it is 0 in the other.
enum class VolumeCount { kPlain, kHalved };

class EdgeList {
 public:
  /// `walls` of find_walls(), or some of them: eye and lights must be inside. Triangles in them
  /// cast no shadow, and edges in them are not extruded.
  explicit EdgeList(const World& world, std::span<const Vec4> walls = {});

  /// The world's, each position once.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// Triples of vertices; each triangle's front as in the world.
  const std::vector<uvec3>& casters() const { return casters_; }
  std::size_t edges() const { return edges_.size(); }

  /// Whether each caster's front faces the light: 1 or -1. One whose plane the light is in may
  /// have either; volumes are right with both.
  std::vector<std::int8_t> facing(const LightPoint& light) const;

  /// Of points outside one of the planes, whose normals look inwards and have length 1, nothing is
  /// asked: parts whose shadows lie wholly there are left out. Silhouettes of closed convex parts
  /// may be off by the angle `slack`, seen from light and eye, and 1.5 % of their part's
  /// radius; the shadow of what is near a light is so many times further off as it is larger.
  ShadowVolumes volumes(const LightPoint& light, const Vec3& eye,
                        VolumeCount count = VolumeCount::kHalved, std::span<const Vec4> region = {},
                        float slack = 0.0f) const;

 private:
  /// A part of the casters that shares no extruded edge with the rest.
  struct Part {
    std::uint32_t first_caster, casters;
    bool even;
    Vec3 centre;
    float radius;
    std::uint32_t first_edge = 0, edges = 0;
    bool convex = false;             // and closed
    std::uint32_t paired_edges = 0;  // the first of these, between two triangles with one front
  };
  struct Edge {
    std::uint32_t a, b;   // a < b
    std::uint32_t first;  // of its faces; they end where those of the next begin
  };

  void weld(const World& world);
  void find_edges(std::span<const std::uint32_t> wall_masks);
  void sort_by_part();
  /// Whether all that the part can throw a shadow on is outside one of the planes.
  static bool is_outside(const Part& part, const LightPoint& light, std::span<const Vec4> region);
  std::int8_t facing(std::uint32_t caster, const LightPoint& light) const;
  static float silhouette_slack(const Part& part, const LightPoint& light, const Vec3& eye,
                                float angle);
  bool is_convex(const Part& part) const;
  void append_edges(const Part& part, std::span<const std::int8_t> light_side, bool halved,
                    std::vector<VolumeEdge>& edges) const;
  int count_at_eye(const Part& part, std::span<const std::int8_t> light_side, const EyeLine& line,
                   const Vec3& eye) const;

  std::vector<Vec3> vertices_;
  std::vector<uvec3> casters_;  // by part
  std::vector<Vec4> planes_;    // of the casters: area vector and offset
  std::vector<Part> parts_;
  std::vector<Edge> edges_;           // by part too
  std::vector<std::uint32_t> faces_;  // 2 * caster + (1 if it runs from b to a)
};

/// Whether the eye is well off the plane of every extruded quad that it could lie in. Where it is
/// not, rounding decides on which side of it the quad is drawn.
bool is_clear_of(const EdgeList& list, const ShadowVolumes& volumes, const LightPoint& light,
                 const Vec3& eye, float distance);

}  // namespace lantern
