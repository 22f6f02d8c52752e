// SPDX-License-Identifier: MIT
#include "lantern/gl/context.h"

#include "lantern/core/error.h"
#include "lantern/gl/devices.h"

#include <fmt/format.h>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <vector>

namespace lantern::gl {
namespace {

struct Version {
  int major, minor;
};

/// The least that serves: GLSL 3.30 and ES 3.00 hold all that the shaders are written in.
Version least(Api api) { return api == Api::kDesktop ? Version{3, 3} : Version{3, 0}; }

std::string name_of(Api api) {
  const Version version = least(api);
  return fmt::format("{} {}.{}", api == Api::kDesktop ? "OpenGL" : "OpenGL ES", version.major,
                     version.minor);
}

/// Whether the library that libepoxy takes this kind of GL from is there: it would end the process
/// instead. What is opened here stays open, as it does there.
bool has_library(Api api) {
  const auto opens = [](const char* name) { return ::dlopen(name, RTLD_LAZY | RTLD_LOCAL); };
  return api == Api::kDesktop ? opens("libOpenGL.so.0") || opens("libGL.so.1")
                              : opens("libGLESv2.so.2") != nullptr;
}

std::string egl_error() { return fmt::format("EGL error 0x{:04x}", eglGetError()); }

/// An initialised display's context of this kind, or EGL_NO_CONTEXT.
EGLContext make_context(EGLDisplay display, Api api) {
  if (!eglBindAPI(api == Api::kDesktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API)) return EGL_NO_CONTEXT;
  EGLConfig config = nullptr;  // EGL_NO_CONFIG_KHR
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE,
                             api == Api::kDesktop ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT,
                             EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  }
  const Version version = least(api);
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION_KHR, version.major,
                                    EGL_CONTEXT_MINOR_VERSION_KHR, version.minor};
  if (api == Api::kDesktop) {
    attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR});
  }
  const auto create = [&](std::vector<EGLint> all) {
    all.push_back(EGL_NONE);
    return eglCreateContext(display, config, EGL_NO_CONTEXT, all.data());
  };
  // After a reset of the GPU calls should say so, where the driver can tell.
  std::vector<EGLint> telling = attributes;
  if (api == Api::kDesktop) {
    telling.insert(telling.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR,
                                   EGL_LOSE_CONTEXT_ON_RESET_KHR});
  } else if (epoxy_has_egl_extension(display, "EGL_EXT_create_context_robustness")) {
    telling.insert(telling.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                                   EGL_LOSE_CONTEXT_ON_RESET_EXT});
  }
  const EGLContext context = create(telling);
  return context != EGL_NO_CONTEXT ? context : create(attributes);
}

/// Empty if the context is current now.
std::string make_current(EGLDisplay display, EGLContext context) {
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return egl_error();
  return glGetString(GL_VERSION) ? "" : "the context does not answer";
}

}  // namespace

Context::Context(const ContextOptions& options) {
  require_egl();
  previous_display_ = eglGetCurrentDisplay();
  previous_context_ = eglGetCurrentContext();
  const std::vector<Api> apis =
      options.api ? std::vector{*options.api} : std::vector{Api::kDesktop, Api::kEs};
  std::string reasons;
  for (const DisplayPlace& place : display_places(options.device)) {
    const auto failed = [&](const std::string& reason) {
      reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", place.name, reason);
    };
    if (place.display == EGL_NO_DISPLAY || !eglInitialize(place.display, nullptr, nullptr)) {
      failed("no display, " + egl_error());
      continue;
    }
    if (!epoxy_has_egl_extension(place.display, "EGL_KHR_surfaceless_context")) {
      failed("needs a window (no EGL_KHR_surfaceless_context)");
      continue;
    }
    for (const Api api : apis) {
      if (!has_library(api)) {
        failed(fmt::format("no library for {}", name_of(api)));
        continue;
      }
      context_ = make_context(place.display, api);
      if (context_ == EGL_NO_CONTEXT) {
        failed(fmt::format("no {}, {}", name_of(api), egl_error()));
        continue;
      }
      const std::string problem = make_current(place.display, context_);
      if (problem.empty()) {
        display_ = place.display;
        place_ = place.name;
        info_ = query_info();
        return;
      }
      eglDestroyContext(place.display, context_);
      failed(fmt::format("{} cannot be used, {}", name_of(api), problem));
    }
  }
  throw Error(fmt::format(
      "no usable OpenGL: {}",
      reasons.empty() ? "EGL lists neither a device nor Mesa's surfaceless platform" : reasons));
}

Context::~Context() {
  if (previous_context_ != EGL_NO_CONTEXT) {
    eglMakeCurrent(previous_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, previous_context_);
  } else {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display_, context_);
}

}  // namespace lantern::gl
