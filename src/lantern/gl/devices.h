// SPDX-License-Identifier: MIT
// The places where EGL can make a context without a window: its devices, in EGL's order, then
// Mesa's surfaceless platform. Displays belong to the process and stay open.
#pragma once

#include <epoxy/egl.h>
#include <optional>
#include <string>
#include <vector>

namespace lantern::gl {

/// Throws Error unless EGL's library is there.
void require_egl();

/// What EGL says its devices are ("/dev/dri/card0", "software"); a device's number is its index.
/// Needs require_egl().
std::vector<std::string> devices();

/// A display that may still have to be initialised.
struct DisplayPlace {
  std::string name;  // for messages
  EGLDisplay display = EGL_NO_DISPLAY;
};

/// Those to try in turn; `device`: that one alone. Throws Error if there is no such device.
std::vector<DisplayPlace> display_places(std::optional<int> device);

}  // namespace lantern::gl
