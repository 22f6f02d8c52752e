// SPDX-License-Identifier: MIT
#include "lantern/raster/stage_times.h"

namespace lantern {

void StageTimes::begin(Stage stage) {
  if (used_ == intervals_.size()) intervals_.push_back({stage, gl::Timer()});
  Interval& interval = intervals_[used_];
  interval.stage = stage;
  interval.timer.begin();
}

void StageTimes::end() { intervals_[used_++].timer.end(); }

void StageTimes::collect() {
  for (std::size_t i = 0; i < used_; ++i) {
    const std::optional<double> seconds = intervals_[i].timer.seconds();
    known_ &= seconds.has_value();
    seconds_[intervals_[i].stage] += seconds.value_or(0.0);
  }
  used_ = 0;
}

std::map<std::string, double> StageTimes::seconds() const {
  std::map<std::string, double> named;
  if (!known_) return named;
  for (const auto& [stage, seconds] : seconds_) {
    named[kStageNames[static_cast<std::size_t>(stage)]] = seconds;
  }
  return named;
}

}  // namespace lantern
