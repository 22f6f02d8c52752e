// SPDX-License-Identifier: MIT
#include "lantern/gl/devices.h"

#include "lantern/core/error.h"

#include <fmt/format.h>

#include <dlfcn.h>

namespace lantern::gl {
namespace {

/// Extensions that need no display. libepoxy asks a display for them and aborts without one.
bool has_client_extension(const char* name) {
  const char* all = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return all && epoxy_extension_in_string(all, name);
}

std::vector<EGLDeviceEXT> device_handles() {
  if (!has_client_extension("EGL_EXT_device_enumeration") &&
      !has_client_extension("EGL_EXT_device_base")) {
    return {};
  }
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> handles(static_cast<std::size_t>(count));
  if (!eglQueryDevicesEXT(count, handles.data(), &count)) return {};
  handles.resize(static_cast<std::size_t>(count));
  return handles;
}

std::string name_of(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  const auto has = [&](const char* name) {
    return extensions && epoxy_extension_in_string(extensions, name);
  };
  if (has("EGL_MESA_device_software")) return "software";
  if (has("EGL_EXT_device_drm")) {
    if (const char* file = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT)) return file;
  }
  return "unnamed";
}

}  // namespace

void require_egl() {
  // libepoxy would end the process instead. What is opened here stays open, as it does there.
  if (!::dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
    const char* reason = ::dlerror();
    throw Error(fmt::format("no usable OpenGL: {}", reason ? reason : "libEGL.so.1 is not there"));
  }
}

std::vector<std::string> devices() {
  std::vector<std::string> names;
  for (const EGLDeviceEXT device : device_handles()) names.push_back(name_of(device));
  return names;
}

std::vector<DisplayPlace> display_places(std::optional<int> device) {
  std::vector<DisplayPlace> all;
  const bool on_device = has_client_extension("EGL_EXT_platform_device");
  const std::vector<EGLDeviceEXT> handles =
      on_device ? device_handles() : std::vector<EGLDeviceEXT>();
  if (device && (*device < 0 || static_cast<std::size_t>(*device) >= handles.size())) {
    throw Error(fmt::format("no OpenGL device {}: EGL lists {}", *device, handles.size()));
  }
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (device && static_cast<std::size_t>(*device) != i) continue;
    all.push_back({fmt::format("device {} ({})", i, name_of(handles[i])),
                   eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, handles[i], nullptr)});
  }
  if (!device && has_client_extension("EGL_MESA_platform_surfaceless")) {
    all.push_back({"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                           EGL_DEFAULT_DISPLAY, nullptr)});
  }
  return all;
}

}  // namespace lantern::gl
