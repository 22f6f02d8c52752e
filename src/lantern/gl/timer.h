// SPDX-License-Identifier: MIT
// How long the GPU works on what is drawn between begin() and end(), as the difference of two time
// stamps: timers may nest. (GL_TIME_ELAPSED may not, and on llvmpipe counts from the start of the
// machine where the first thing timed is a clear.)
#pragma once

#include "lantern/gl/objects.h"

#include <optional>

namespace lantern::gl {

void delete_query(GLuint id);

class Timer {
 public:
  Timer();

  void begin();
  void end();

  /// Of the last begin() and end(), once the GPU is done with it. None where this GL has no timers
  /// (kTimers) or something else disturbed them.
  std::optional<double> seconds() const;

 private:
  bool available_;
  Handle<delete_query> begin_, end_;
};

}  // namespace lantern::gl
