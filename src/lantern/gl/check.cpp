// SPDX-License-Identifier: MIT
#include "lantern/gl/check.h"

#include "lantern/core/error.h"

#include <fmt/format.h>

#include <epoxy/gl.h>
#include <string>

namespace lantern::gl {
namespace {

std::string name_of(GLenum error) {
  constexpr GLenum kContextLost = 0x0507;  // of GL 4.5 and KHR_robustness
  switch (error) {
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case kContextLost:
      return "the context is lost (the GPU was reset)";
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    default:
      return fmt::format("error 0x{:04x}", error);
  }
}

}  // namespace

void check(const char* doing) {
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) throw Error(fmt::format("OpenGL, {}: {}", doing, name_of(error)));
}

}  // namespace lantern::gl
