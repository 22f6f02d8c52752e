// SPDX-License-Identifier: MIT
#include "lantern/gl/program.h"

#include "lantern/core/error.h"
#include "lantern/gl/check.h"
#include "lantern/gl/shader_source.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

namespace lantern::gl {
namespace {

void delete_shader(GLuint id) { glDeleteShader(id); }
using Shader = Handle<delete_shader>;

std::string prelude(const std::vector<Definition>& definitions) {
  std::string text;
  if (epoxy_is_desktop_gl()) {
    text = "#version 330 core\n";
  } else {
    text =
        "#version 300 es\n"
        "precision highp float;\nprecision highp int;\n"
        "precision highp sampler2D;\nprecision highp usampler2D;\n";
  }
  for (const Definition& d : definitions) text += fmt::format("#define {} {}\n", d.name, d.value);
  // Files that the C++ compiler reads too say this where C++ needs `inline`.
  text += "#define LANTERN_SHARED\n";
  return text;
}

std::string log_of(GLuint id, decltype(glGetShaderiv) get, decltype(glGetShaderInfoLog) get_log) {
  GLint length = 0;
  get(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  get_log(id, length, nullptr, log.data());
  log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
  return log;
}

Shader compile(GLenum stage, const ShaderSource& source) {
  Shader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint compiled = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    throw compile_error(source, log_of(shader.id(), glGetShaderiv, glGetShaderInfoLog));
  }
  return shader;
}

}  // namespace

void delete_program(GLuint id) { glDeleteProgram(id); }

Program::Program(const ShaderFiles& files, const std::string& vertex, const std::string& fragment,
                 const std::vector<Definition>& definitions)
    : handle_(glCreateProgram()) {
  const std::string first = prelude(definitions);
  const Shader vertex_shader = compile(GL_VERTEX_SHADER, compose(files, vertex, first));
  const Shader fragment_shader = compile(GL_FRAGMENT_SHADER, compose(files, fragment, first));
  glAttachShader(handle_.id(), vertex_shader.id());
  glAttachShader(handle_.id(), fragment_shader.id());
  glLinkProgram(handle_.id());
  GLint linked = 0;
  glGetProgramiv(handle_.id(), GL_LINK_STATUS, &linked);
  if (!linked) {
    throw Error({.file = vertex},
                fmt::format("does not link with {}: {}", fragment,
                            log_of(handle_.id(), glGetProgramiv, glGetProgramInfoLog)));
  }
  check("making a program");
}

void Program::use() const { glUseProgram(handle_.id()); }

GLint Program::location(const char* uniform) const {
  use();
  const GLint at = glGetUniformLocation(handle_.id(), uniform);
  assert(at >= 0);
  return at;
}

void Program::set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
void Program::set(const char* uniform, std::uint32_t value) const {
  glUniform1ui(location(uniform), value);
}
void Program::set(const char* uniform, float value) const { glUniform1f(location(uniform), value); }
void Program::set(const char* uniform, const glm::ivec2& value) const {
  glUniform2iv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Vec2& value) const {
  glUniform2fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Vec3& value) const {
  glUniform3fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Vec4& value) const {
  glUniform4fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Mat3& value) const {
  glUniformMatrix3fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Mat4& value) const {
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* sampler, int unit, const Texture& texture) const {
  texture.bind(unit);
  set(sampler, unit);
}
void Program::set_block(const char* block, GLuint binding) const {
  const GLuint at = glGetUniformBlockIndex(handle_.id(), block);
  assert(at != GL_INVALID_INDEX);
  glUniformBlockBinding(handle_.id(), at, binding);
}

void draw_full_screen(const VertexArray& without_attributes) {
  without_attributes.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace lantern::gl
