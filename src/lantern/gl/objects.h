// SPDX-License-Identifier: MIT
// GL's objects, owned: buffers, 2D textures, framebuffers, vertex arrays. Each belongs to the
// context that is current when it is made and must go before that does. Errors: Error where memory
// or a limit of this GL does not suffice.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <epoxy/gl.h>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace lantern::gl {

/// A name of GL, deleted with its owner.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  explicit Handle(GLuint id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ != 0) Delete(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_;
};

void delete_buffer(GLuint id);
void delete_texture(GLuint id);
void delete_framebuffer(GLuint id);
void delete_vertex_array(GLuint id);

class Buffer {
 public:
  explicit Buffer(std::span<const std::byte> bytes);
  template <typename T>
  explicit Buffer(std::span<const T> values) : Buffer(std::as_bytes(values)) {}

  /// Other contents, of any length; what draws from the old ones still does.
  template <typename T>
  void write(std::span<const T> values) {
    write_bytes(std::as_bytes(values));
  }
  /// As the uniform block with this binding.
  void bind_as_uniforms(GLuint binding) const;

  GLuint id() const { return handle_.id(); }

 private:
  void write_bytes(std::span<const std::byte> bytes);

  Handle<delete_buffer> handle_;
};

/// What a texel is. The formats that one can draw into (floats on ES: where kFloatTargets is).
enum class Format {
  kRgba8,
  kR32f,
  kRgba32f,
  kR32ui,
  kRg32ui,
  kRgba32ui,
  kDepth32f,
  kDepth32fStencil8
};

struct TextureOptions {
  bool linear = false;   // bilinear, 32-bit floats where kFloatFiltering is; else nearest
  bool mipmaps = false;  // all levels; see Texture::make_mipmaps()
};

/// Clamped at its edges. Starts with nothing in it unless texels are given.
class Texture {
 public:
  Texture(Format format, int width, int height, const TextureOptions& options = {});

  GLuint id() const { return handle_.id(); }
  Format format() const { return format_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int levels() const { return levels_; }

  /// All texels, row 0 first; T is the format's channel (float, uint32_t or uint8_t).
  template <typename T>
  void write(std::span<const T> channels) {
    write({0, 0, width_, height_}, channels);
  }
  struct Area {
    int x, y, width, height;
  };
  template <typename T>
  void write(const Area& area, std::span<const T> channels) {
    require_channel(sizeof(T), std::is_floating_point_v<T>, area, channels.size());
    write_bytes(area, channels.data());
  }
  /// Levels 1 and up, each the mean of the one below.
  void make_mipmaps();
  void bind(int unit) const;

 private:
  void require_channel(std::size_t size, bool floating, const Area& area, std::size_t count) const;
  void write_bytes(const Area& area, const void* data);

  Handle<delete_texture> handle_;
  Format format_;
  int width_, height_, levels_;
};

/// Draws into textures: colours at locations 0, 1, ..., and a depth, as far from their first texels
/// as all of them reach. They must outlive it.
class Framebuffer {
 public:
  explicit Framebuffer(std::initializer_list<const Texture*> colours,
                       const Texture* depth = nullptr);

  /// Draws go here, to all of it.
  void bind() const;

  /// What is in the colour `i`: rows from 0 up, all channels of its format. T as in write().
  template <typename T>
  std::vector<T> read(std::size_t i = 0) const {
    std::vector<T> channels(channels_of(i, sizeof(T), std::is_floating_point_v<T>));
    read_bytes(i, channels.data());
    return channels;
  }

 private:
  std::size_t channels_of(std::size_t i, std::size_t size, bool floating) const;
  void read_bytes(std::size_t i, void* data) const;

  Handle<delete_framebuffer> handle_;
  std::vector<Format> colours_;
  int width_ = 0, height_ = 0;
};

/// One attribute of the vertices: `channels` floats or unsigned integers, tightly packed.
struct Attribute {
  GLuint location = 0;
  const Buffer* buffer = nullptr;
  int channels = 3;
  bool integer = false;
};

class VertexArray {
 public:
  /// Without attributes: for shaders that make their vertices of gl_VertexID. `indices` are 32 bits
  /// each. The buffers must outlive the array.
  explicit VertexArray(std::initializer_list<Attribute> attributes = {},
                       const Buffer* indices = nullptr);

  void add(const Attribute& attribute) const;
  void bind() const;

 private:
  Handle<delete_vertex_array> handle_;
};

}  // namespace lantern::gl
