// SPDX-License-Identifier: MIT
// How long the GPU works on each stage of its pictures. Where GL has no timers nothing is known.
#pragma once

#include "lantern/gl/timer.h"

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace lantern {

enum class Stage { kSurfaces, kVolumes, kMaps, kShading, kFilter, kResolve };
inline constexpr std::array kStageNames = {"surfaces", "volumes", "maps",
                                           "shading",  "filter",  "resolve"};

class StageTimes {
 public:
  /// What is drawn from now until end() belongs to this stage.
  void begin(Stage stage);
  void end();

  /// Adds up all that has ended; waits for the GPU.
  void collect();
  /// Seconds that were collected, by the names of the stages that were drawn; nothing without
  /// timers, or if something disturbed one of them.
  std::map<std::string, double> seconds() const;

 private:
  struct Interval {
    Stage stage;
    gl::Timer timer;
  };
  std::vector<Interval> intervals_;
  std::size_t used_ = 0;  // so many of them wait to be collected, the others to be used again
  std::map<Stage, double> seconds_;
  bool known_ = true;
};

}  // namespace lantern
