// SPDX-License-Identifier: MIT
// A vertex and a fragment shader, composed of files (see shader_source.h) in the subset of ES 3.00
// that GLSL 3.30, ES and WebGL 2 share; the prelude says which of them it is. A compiler's
// complaint: Error with the file and line.
#pragma once

#include "lantern/core/math.h"
#include "lantern/gl/objects.h"
#include "lantern/gl/shader_files.h"

#include <string>
#include <vector>

namespace lantern::gl {

struct Definition {
  std::string name, value;
};

void delete_program(GLuint id);

class Program {
 public:
  /// `vertex` and `fragment` are names of files.
  Program(const ShaderFiles& files, const std::string& vertex, const std::string& fragment,
          const std::vector<Definition>& definitions = {});

  void use() const;

  /// Of the program, which this makes the current one. Naming none of its uniforms is a mistake.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, std::uint32_t value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const glm::ivec2& value) const;
  void set(const char* uniform, const Vec2& value) const;
  void set(const char* uniform, const Vec3& value) const;
  void set(const char* uniform, const Vec4& value) const;
  void set(const char* uniform, const Mat3& value) const;
  void set(const char* uniform, const Mat4& value) const;
  /// A sampler's texture, by way of this unit.
  void set(const char* sampler, int unit, const Texture& texture) const;
  /// A uniform block's binding; see Buffer::bind_as_uniforms().
  void set_block(const char* block, GLuint binding) const;

 private:
  GLint location(const char* uniform) const;

  Handle<delete_program> handle_;
};

/// One triangle over all of the framebuffer that is bound, for shaders/full_screen.vert.glsl.
void draw_full_screen(const VertexArray& without_attributes);

}  // namespace lantern::gl
