// SPDX-License-Identifier: MIT
// The sum of all texels of an RGBA32F texture, by GL, in a texture of one texel. Blocks of 16x16
// texels at a time, always in the same order: the same bits every time.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"

#include <vector>

namespace lantern {

class Reduction {
 public:
  static constexpr int kBlock = 16;  // as in shaders/sum.frag.glsl
  static int blocks(int texels) { return (texels + kBlock - 1) / kBlock; }

  /// For values of this size; `weights`, if not null, is the texture of the same size whose fourth
  /// channel multiplies them. It must outlive the reduction.
  Reduction(int width, int height, const gl::Texture* weights, const gl::ShaderFiles& files);

  void run(const gl::Texture& values);
  const gl::Texture& result() const { return levels_.back(); }

 private:
  const gl::Texture* weights_;
  std::vector<gl::Texture> levels_;
  std::vector<gl::Framebuffer> framebuffers_;
  gl::Program first_, next_;
  gl::VertexArray no_attributes_;
};

}  // namespace lantern
