// SPDX-License-Identifier: MIT
// What the command tells people while it works, on standard error; and Ctrl-C.
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/pipeline/render.h"

#include <chrono>
#include <string>

namespace lantern::app {

/// One line that starts with "warning:".
void warn(const std::string& text);

/// One line that says what is going to happen.
void note(const std::string& text);

/// A bar with the time left on a terminal, a line now and then elsewhere.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  void show(const Progress& progress);

 private:
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

/// The first Ctrl-C (or SIGTERM) sets the flag returned here, a second one ends the program.
const StopFlag& stop_on_interrupt();

/// From now on nothing interrupts the program: what it writes is written whole.
void finish_in_peace();

}  // namespace lantern::app
