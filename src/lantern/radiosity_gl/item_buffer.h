// SPDX-License-Identifier: MIT
// A hemicube's item buffer, drawn by GL: which triangle of the world each of its pixels sees, and
// the share of the form factor that sees nothing. [Cohen & Greenberg 1985]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/radiosity_gl/reduction.h"
#include "lantern/scene/world.h"

#include <vector>

namespace lantern {

/// Where a hemicube stands: a hair off its surface; rows of `to_local` are its tangents and normal.
struct HemicubePose {
  Vec3 origin;
  Mat3 to_local;
  Vec2 shift{0.0f};  // of what a pixel looks at from its centre, in pixels
};

class ItemBuffer {
 public:
  /// `resolution` are the pixels along the top's edge, even; `back_alive` says for each
  /// triangle whether its back takes up light.
  ItemBuffer(const World& world, const std::vector<bool>& back_alive, int resolution,
             const gl::ShaderFiles& files);

  void draw(const HemicubePose& pose);

  /// Of resolution x 3 resolution texels in the layout of shaders/hemicube.glsl: 0 for nothing,
  /// else the triangle's number plus 1, with the top bit set where its back is seen that takes up
  /// none.
  const gl::Texture& items() const { return items_; }
  /// Of the triangles: dot(xyz, x) + w = 0.
  const gl::Texture& planes() const { return planes_; }
  /// One texel: the sum of all delta form factors, and of those that see nothing alive.
  const gl::Texture& lost() const { return lost_sum_.result(); }

 private:
  int resolution_;
  float near_;
  GLsizei vertex_count_;
  gl::Buffer positions_, surfaces_;
  gl::VertexArray vertices_;
  gl::Texture planes_, items_, depth_;
  gl::Framebuffer framebuffer_;
  gl::Program draw_items_, find_lost_;
  gl::Texture lost_;  // one texel for each block of the items
  gl::Framebuffer lost_framebuffer_;
  gl::VertexArray no_attributes_;
  Reduction lost_sum_;
};

}  // namespace lantern
