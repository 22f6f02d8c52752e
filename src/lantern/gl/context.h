// SPDX-License-Identifier: MIT
// A GL context without a window, through EGL: on a device, or on Mesa's surfaceless platform.
// Desktop core 3.3 or newer, or ES 3.0 or newer. No usable GL: Error with every reason met.
#pragma once

#include "lantern/gl/info.h"

#include <optional>
#include <string>

namespace lantern::gl {

enum class Api { kDesktop, kEs };

struct ContextOptions {
  std::optional<Api> api;     // none: desktop GL where it is there, else ES
  std::optional<int> device;  // of devices(); none: the first place that works
};

/// Current on the thread that makes it, for as long as it lives; then the one before is again. All
/// GL objects made meanwhile must go before it does.
class Context {
 public:
  explicit Context(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Info& info() const { return info_; }
  /// "device 0 (software)", "surfaceless".
  const std::string& place() const { return place_; }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  void* previous_display_ = nullptr;
  void* previous_context_ = nullptr;
  std::string place_;
  Info info_;
};

}  // namespace lantern::gl
