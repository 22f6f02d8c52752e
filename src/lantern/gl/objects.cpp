// SPDX-License-Identifier: MIT
#include "lantern/gl/objects.h"

#include "lantern/core/error.h"
#include "lantern/gl/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace lantern::gl {
namespace {

/// One line of GL's table of sized internal formats: format and type must be those that belong to
/// the internal format, or what is read is garbage without an error.
struct FormatData {
  GLint internal;
  GLenum format, type;
  std::size_t channels, channel_bytes;
  bool floating;
};

FormatData data_of(Format format) {
  switch (format) {
    case Format::kRgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, 1, false};
    case Format::kR32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 1, 4, true};
    case Format::kRgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 4, 4, true};
    case Format::kR32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 4, false};
    case Format::kRg32ui:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 2, 4, false};
    case Format::kRgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4, 4, false};
    case Format::kDepth32fStencil8:
      return {
          GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 1, 8, false};
    case Format::kDepth32f:
      break;
  }
  return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1, 4, true};
}

GLuint generate(void (*make)(GLsizei, GLuint*)) {
  GLuint id = 0;
  make(1, &id);
  return id;
}

GLuint make_buffer() {
  return generate([](GLsizei n, GLuint* ids) { glGenBuffers(n, ids); });
}
GLuint make_texture() {
  return generate([](GLsizei n, GLuint* ids) { glGenTextures(n, ids); });
}
GLuint make_framebuffer() {
  return generate([](GLsizei n, GLuint* ids) { glGenFramebuffers(n, ids); });
}
GLuint make_vertex_array() {
  return generate([](GLsizei n, GLuint* ids) { glGenVertexArrays(n, ids); });
}

std::size_t texels_of(const Texture::Area& area) {
  return static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height);
}

}  // namespace

void delete_buffer(GLuint id) { glDeleteBuffers(1, &id); }
void delete_texture(GLuint id) { glDeleteTextures(1, &id); }
void delete_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
void delete_vertex_array(GLuint id) { glDeleteVertexArrays(1, &id); }

Buffer::Buffer(std::span<const std::byte> bytes) : handle_(make_buffer()) { write_bytes(bytes); }

void Buffer::write_bytes(std::span<const std::byte> bytes) {
  // WebGL ties a buffer to the kind of its first target, but for this one.
  glBindBuffer(GL_COPY_WRITE_BUFFER, id());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
               GL_STATIC_DRAW);
  check("writing a buffer");
}

void Buffer::bind_as_uniforms(GLuint binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

Texture::Texture(Format format, int width, int height, const TextureOptions& options)
    : handle_(make_texture()),
      format_(format),
      width_(width),
      height_(height),
      levels_(options.mipmaps
                  ? static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(width, height))))
                  : 1) {
  assert(width > 0 && height > 0);
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (std::max(width, height) > largest) {
    throw Error(fmt::format("OpenGL: a texture of {}x{} is needed, {} is the most it takes", width,
                            height, largest));
  }
  const FormatData data = data_of(format);
  glBindTexture(GL_TEXTURE_2D, id());
  for (int level = 0; level < levels_; ++level) {
    glTexImage2D(GL_TEXTURE_2D, level, data.internal, std::max(width >> level, 1),
                 std::max(height >> level, 1), 0, data.format, data.type, nullptr);
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, levels_ - 1);
  const GLint nearest = options.mipmaps ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST;
  const GLint linear = options.mipmaps ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, options.linear ? linear : nearest);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, options.linear ? GL_LINEAR : GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  check("making a texture");
}

void Texture::require_channel(std::size_t size, bool floating, const Area& area,
                              std::size_t count) const {
  [[maybe_unused]] const FormatData data = data_of(format_);
  assert(size == data.channel_bytes && floating == data.floating);
  assert(count == texels_of(area) * data.channels);
  static_cast<void>(size), static_cast<void>(floating), static_cast<void>(area),
      static_cast<void>(count);
}

void Texture::write_bytes(const Area& area, const void* texels) {
  const FormatData data = data_of(format_);
  glBindTexture(GL_TEXTURE_2D, id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, area.x, area.y, area.width, area.height, data.format, data.type,
                  texels);
  check("writing a texture");
}

void Texture::make_mipmaps() {
  assert(levels_ > 1 || std::max(width_, height_) == 1);
  glBindTexture(GL_TEXTURE_2D, id());
  glGenerateMipmap(GL_TEXTURE_2D);
  check("making mipmaps");
}

void Texture::bind(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, id());
}

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth)
    : handle_(make_framebuffer()) {
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.id());
  std::vector<GLenum> targets;
  const auto attach = [&](GLenum attachment, const Texture& texture) {
    width_ = width_ == 0 ? texture.width() : std::min(width_, texture.width());
    height_ = height_ == 0 ? texture.height() : std::min(height_, texture.height());
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.id(), 0);
  };
  for (const Texture* colour : colours) {
    const auto target = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size());
    attach(target, *colour);
    targets.push_back(target);
    colours_.push_back(colour->format());
  }
  if (depth) {
    attach(depth->format() == Format::kDepth32fStencil8 ? GL_DEPTH_STENCIL_ATTACHMENT
                                                        : GL_DEPTH_ATTACHMENT,
           *depth);
  }
  if (targets.empty()) {
    targets.push_back(GL_NONE);
    glReadBuffer(GL_NONE);
  }
  glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error(fmt::format("OpenGL cannot draw into these textures (status 0x{:04x})", status));
  }
  check("making a framebuffer");
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.id());
  glViewport(0, 0, width_, height_);
}

std::size_t Framebuffer::channels_of(std::size_t i, std::size_t size, bool floating) const {
  const FormatData data = data_of(colours_.at(i));
  assert(size == data.channel_bytes && floating == data.floating);
  static_cast<void>(size), static_cast<void>(floating);
  return texels_of({0, 0, width_, height_}) * data.channels;
}

void Framebuffer::read_bytes(std::size_t i, void* texels) const {
  const FormatData data = data_of(colours_[i]);
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, data.format, data.type, texels);
  check("reading pixels");
}

VertexArray::VertexArray(std::initializer_list<Attribute> attributes, const Buffer* indices)
    : handle_(make_vertex_array()) {
  bind();
  if (indices) glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices->id());
  for (const Attribute& attribute : attributes) add(attribute);
  check("making a vertex array");
}

void VertexArray::add(const Attribute& attribute) const {
  bind();
  glBindBuffer(GL_ARRAY_BUFFER, attribute.buffer->id());
  glEnableVertexAttribArray(attribute.location);
  if (attribute.integer) {
    glVertexAttribIPointer(attribute.location, attribute.channels, GL_UNSIGNED_INT, 0, nullptr);
  } else {
    glVertexAttribPointer(attribute.location, attribute.channels, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
}

void VertexArray::bind() const { glBindVertexArray(handle_.id()); }

}  // namespace lantern::gl
