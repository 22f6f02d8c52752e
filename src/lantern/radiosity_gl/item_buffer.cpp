// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/item_buffer.h"

#include "lantern/gl/check.h"
#include "lantern/radiosity_gl/texels.h"

#include <array>
#include <cstdint>
#include <span>

namespace lantern {
namespace {

gl::Buffer make_positions(const World& world) {
  std::vector<Vec3> positions;
  positions.reserve(3 * world.size());
  for (const uvec3& v : world.triangles) {
    for (int k = 0; k < 3; ++k) positions.push_back(world.positions[v[k]]);
  }
  return gl::Buffer(std::span<const Vec3>(positions));
}

gl::Buffer make_surfaces(const World& world, const std::vector<bool>& back_alive) {
  std::vector<std::uint32_t> surfaces;
  surfaces.reserve(3 * world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    surfaces.insert(surfaces.end(), 3, 2 * t + (back_alive[t] ? 1u : 0u));
  }
  return gl::Buffer(std::span<const std::uint32_t>(surfaces));
}

gl::Texture make_planes(const World& world) {
  const TexelGrid grid(world.size());
  std::vector<Vec4> planes(grid.texels(), Vec4(0.0f));
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(world.area_vector(t)));
    const glm::dvec3 corner(world.positions[world.triangles[t].x]);
    planes[t] = Vec4(Vec3(normal), static_cast<float>(-glm::dot(normal, corner)));
  }
  return make_texture(grid, planes);
}

/// Half the hair that hemicubes stand off their surface, in scales of the scene: nothing that could
/// be seen is nearer.
constexpr float kNear = 0x1p-19f;

}  // namespace

ItemBuffer::ItemBuffer(const World& world, const std::vector<bool>& back_alive, int resolution,
                       const gl::ShaderFiles& files)
    : resolution_(resolution),
      near_(world.coordinate_scale() * kNear),
      vertex_count_(static_cast<GLsizei>(3 * world.size())),
      positions_(make_positions(world)),
      surfaces_(make_surfaces(world, back_alive)),
      vertices_({{.location = 0, .buffer = &positions_, .channels = 3, .integer = false},
                 {.location = 1, .buffer = &surfaces_, .channels = 1, .integer = true}}),
      planes_(make_planes(world)),
      items_(gl::Format::kR32ui, resolution, 3 * resolution),
      depth_(gl::Format::kDepth32f, resolution, 3 * resolution),
      framebuffer_({&items_}, &depth_),
      draw_items_(files, "shaders/items.vert.glsl", "shaders/items.frag.glsl"),
      find_lost_(files, "shaders/full_screen.vert.glsl", "shaders/lost.frag.glsl"),
      lost_(gl::Format::kRgba32f, Reduction::blocks(resolution), Reduction::blocks(3 * resolution)),
      lost_framebuffer_({&lost_}),
      lost_sum_(lost_.width(), lost_.height(), nullptr, files) {}

void ItemBuffer::draw(const HemicubePose& pose) {
  framebuffer_.bind();
  constexpr std::array<GLuint, 4> kNothing = {0, 0, 0, 0};
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glClearDepthf(0.0f);
  glClearBufferuiv(GL_COLOR, 0, kNothing.data());
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_items_.set("origin", pose.origin);
  draw_items_.set("to_local", pose.to_local);
  draw_items_.set("near", near_);
  draw_items_.set("shift", pose.shift * (2.0f / static_cast<float>(resolution_)));
  draw_items_.set("planes", 0, planes_);
  vertices_.bind();
  const int n = resolution_;
  constexpr int kFaces = 5;
  for (int face = 0; face < kFaces; ++face) {
    if (face == 0) {
      glViewport(0, 0, n, n);
    } else {
      glViewport(0, n + (face - 1) * n / 2, n, n / 2);
    }
    draw_items_.set("face", face);
    glDrawArrays(GL_TRIANGLES, 0, vertex_count_);
  }
  glDisable(GL_DEPTH_TEST);

  lost_framebuffer_.bind();
  find_lost_.set("items", 0, items_);
  gl::draw_full_screen(no_attributes_);
  lost_sum_.run(lost_);
  gl::check("drawing an item buffer");
}

}  // namespace lantern
