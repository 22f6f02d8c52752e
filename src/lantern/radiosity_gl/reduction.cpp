// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/reduction.h"

namespace lantern {
namespace {

gl::Program make_sum(const gl::ShaderFiles& files, bool weighted) {
  return {
      files, "shaders/full_screen.vert.glsl", "shaders/sum.frag.glsl",
      weighted ? std::vector<gl::Definition>{{"WEIGHTED", "1"}} : std::vector<gl::Definition>{}};
}

}  // namespace

Reduction::Reduction(int width, int height, const gl::Texture* weights,
                     const gl::ShaderFiles& files)
    : weights_(weights),
      first_(make_sum(files, weights != nullptr)),
      next_(make_sum(files, false)) {
  do {
    width = blocks(width);
    height = blocks(height);
    levels_.emplace_back(gl::Format::kRgba32f, width, height);
  } while (width > 1 || height > 1);
  for (const gl::Texture& level : levels_) framebuffers_.emplace_back(gl::Framebuffer({&level}));
}

void Reduction::run(const gl::Texture& values) {
  const gl::Texture* from = &values;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const gl::Program& program = i == 0 ? first_ : next_;
    program.set("values", 0, *from);
    if (i == 0 && weights_) program.set("normals", 1, *weights_);
    framebuffers_[i].bind();
    gl::draw_full_screen(no_attributes_);
    from = &levels_[i];
  }
}

}  // namespace lantern
