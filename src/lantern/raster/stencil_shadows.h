// SPDX-License-Identifier: MIT
// Which of up to 32 lights each pixel sees, as the bits of a mask, by shadow volumes in the stencil
// buffer, counted by one of the methods of volume_method.h.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/edge_list.h"
#include "lantern/raster/stage_times.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/view.h"
#include "lantern/raster/volume_method.h"

#include <optional>
#include <span>
#include <vector>

namespace lantern {

/// Lights, 32 at most, and from where their shadows are seen.
struct LightsInView {
  const View& view;
  std::span<const LightPoint> lights;
  // For each the plane with all that it shines on before it, of length 1; none: it shines around.
  std::span<const Vec4> fronts = {};
  float slack = 0.0f;  // in pixels of this view: how far silhouettes may be off; see EdgeList
};

struct IndexRange {
  std::size_t first = 0, count = 0;
};

class StencilShadows {
 public:
  /// Keeps references. `casters`: those of the world's triangles that cast shadows; none: all.
  StencilShadows(const World& world, const gl::ShaderFiles& files, VolumeMethod method,
                 const World* casters = nullptr);

  /// Bit i of a mask (RGBA8, the lowest byte in red): whether light i is seen. Each view has its
  /// part of the mask; bits of lights that it has not may be anything. `framebuffer` draws into the
  /// mask with a stencil, which must be 0 and is left so, and the depth that the views see; see
  /// needs_depth_of_view(). Drawing is timed.
  void draw(std::span<const LightsInView> views, const gl::Framebuffer& framebuffer,
            StageTimes& times);
  void draw(std::span<const LightPoint> lights, const View& view,
            const gl::Framebuffer& framebuffer, StageTimes& times) {
    const LightsInView all{view, lights};
    draw(std::span(&all, 1), framebuffer, times);
  }

  /// Whether the depth that volumes are drawn against must be of that very view, to its last bit.
  bool needs_depth_of_view() const { return method_ == VolumeMethod::kZFail; }

  /// How many sides of the volumes of one light each pixel has before its surface: fronts in red,
  /// backs in green of an RGBA8 framebuffer with a depth as above.
  void draw_sides(const LightPoint& light, const View& view, const gl::Framebuffer& framebuffer);

 private:
  /// A light, its number in its group, and what is drawn of it.
  struct Prepared {
    LightPoint light{0.0f};
    std::optional<Vec4> front;
    std::size_t number = 0;
    const View* view = nullptr;
    float slack = 0.0f;
    ShadowVolumes volumes;
    const EdgeList* list = nullptr;
    int reference = 0;
    IndexRange quads, outward_caps, inward_caps;
  };

  void choose_walls(const Vec3& eye);
  /// The first lights of all views, the second, ...
  std::vector<Prepared> prepare(std::span<const LightsInView> views);
  void find_volumes(Prepared& prepared) const;
  int complete_count(const Prepared& prepared) const;
  static std::size_t size_of_batch(std::span<const Prepared> prepared);
  void write_indices(std::span<Prepared> prepared, const Bounds& box);
  void count(const Prepared& prepared, const View& view) const;
  void take(std::size_t number, int reference, const View& view) const;

  const World& world_;
  const World& casters_;
  VolumeMethod method_;
  gl::Program volume_, sides_, take_;
  gl::VertexArray no_vertices_;
  std::vector<Vec4> all_walls_, walls_;
  EdgeList whole_;                  // of all triangles
  std::optional<EdgeList> inside_;  // of those that matter between points inside the walls
  gl::Buffer vertices_, indices_;
  gl::VertexArray array_;
};

}  // namespace lantern
