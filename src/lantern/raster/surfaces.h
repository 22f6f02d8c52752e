// SPDX-License-Identifier: MIT
// What each pixel sees, drawn once: the surfaces of a scene into a G-buffer.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/raster/bodies.h"
#include "lantern/raster/view.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace lantern {

/// See shaders/surface.frag.glsl. Depth and stencil are of the same texture.
struct GBuffer {
  gl::Texture points, reflectances, emissions, depth;
  gl::Framebuffer framebuffer;

  GBuffer(int width, int height);
  GBuffer(const GBuffer&) = delete;
  GBuffer& operator=(const GBuffer&) = delete;
};

class Surfaces {
 public:
  /// Keeps a reference to `scene`.
  Surfaces(const Scene& scene, const World& world, const gl::ShaderFiles& files);

  /// All of it, with the sky behind, into the view's part; its stencil becomes 0.
  void draw(const View& view, const GBuffer& target) const;

  /// The uniforms of shaders/opacity.glsl for this material, on a texture unit.
  void set_opacity(const gl::Program& program, std::size_t material, int unit) const;

 private:
  struct Batch {
    std::size_t material;
    std::vector<Body> bodies;
  };
  std::vector<std::uint32_t> make_batches(const World& world);
  static void draw_bodies(const Batch& batch, const View& view);
  void set_view(const gl::Program& program, const View& view) const;
  /// A texture on a unit and how it is looked up.
  void set_look_up(const gl::Program& program, const char* sampler, const char* how, int unit,
                   const std::optional<TextureId>& texture) const;

  const Scene& scene_;
  float lift_;
  bool textured_;  // any of the materials
  gl::Program surface_, surface_with_holes_, sky_;
  std::map<TextureId, gl::Texture> textures_;
  gl::Texture no_texture_;
  std::vector<gl::Buffer> buffers_;
  std::vector<Batch> batches_;
  std::optional<gl::VertexArray> vertices_;
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
