// SPDX-License-Identifier: MIT
#include "lantern/gl/info.h"

#include <algorithm>
#include <cassert>
#include <epoxy/gl.h>
#include <initializer_list>

namespace lantern::gl {
namespace {

std::string text_of(GLenum what) {
  const GLubyte* text = glGetString(what);
  return text ? reinterpret_cast<const char*>(text) : "";
}

int integer_of(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return value;
}

/// Desktop GL 3.3 has it; ES by one of these.
Feature feature(const char* name, bool es, std::initializer_list<const char*> extensions) {
  if (!es) return {name, "core"};
  for (const char* extension : extensions) {
    if (epoxy_has_gl_extension(extension)) return {name, extension};
  }
  return {name, ""};
}

Feature newer_feature(const char* name, bool core, const char* extension) {
  if (core) return {name, "core"};
  return {name, epoxy_has_gl_extension(extension) ? extension : ""};
}

}  // namespace

bool Info::has(const std::string& feature) const {
  const auto found = std::find_if(features.begin(), features.end(),
                                  [&](const auto& f) { return f.name == feature; });
  assert(found != features.end());
  return !found->by.empty();
}

int Info::limit(const std::string& name) const {
  const auto found =
      std::find_if(limits.begin(), limits.end(), [&](const auto& l) { return l.name == name; });
  assert(found != limits.end());
  return found->value;
}

Info query_info() {
  Info info;
  info.vendor = text_of(GL_VENDOR);
  info.renderer = text_of(GL_RENDERER);
  info.version = text_of(GL_VERSION);
  info.glsl = text_of(GL_SHADING_LANGUAGE_VERSION);
  info.es = !epoxy_is_desktop_gl();
  const int version = epoxy_gl_version();  // 10 major + minor
  info.major = version / 10;
  info.minor = version % 10;
  info.features = {
      feature(kFloatTargets, info.es, {"GL_EXT_color_buffer_float"}),
      feature(kFloatBlending, info.es, {"GL_EXT_float_blend"}),
      feature(kFloatFiltering, info.es, {"GL_OES_texture_float_linear"}),
      feature(kDepthClamp, info.es, {"GL_EXT_depth_clamp"}),
      newer_feature(kClipControl, !info.es && epoxy_gl_version() >= 45,
                    info.es ? "GL_EXT_clip_control" : "GL_ARB_clip_control"),
      feature(kTimers, info.es, {"GL_EXT_disjoint_timer_query"}),
  };
  info.limits = {
      {kTextureSize, integer_of(GL_MAX_TEXTURE_SIZE)},
      {"array layers", integer_of(GL_MAX_ARRAY_TEXTURE_LAYERS)},
      {"texture units", integer_of(GL_MAX_TEXTURE_IMAGE_UNITS)},
      {"draw buffers", integer_of(GL_MAX_DRAW_BUFFERS)},
      {"samples", integer_of(GL_MAX_SAMPLES)},
      {"uniform block bytes", integer_of(GL_MAX_UNIFORM_BLOCK_SIZE)},
  };
  return info;
}

}  // namespace lantern::gl
