// SPDX-License-Identifier: MIT
#include "lantern/pipeline/passes.h"

#include <algorithm>
#include <limits>

namespace lantern {

Passes::Passes(const RenderJob& job) : job_(job), sum_(job.options.width, job.options.height) {}

bool Passes::next() {
  const RenderOptions& options = job_.options;
  if (options.passes > 0 && begun_ >= options.passes) return false;
  if (begun_ > 0) {
    if (job_.stop.load()) return false;
    const double per_pass = watch_.seconds() / static_cast<double>(begun_);
    if (options.seconds && job_.elapsed + job_.watch.seconds() + per_pass > *options.seconds) {
      return false;
    }
  }
  ++begun_;
  return true;
}

bool Passes::add(const Image& image) {
  if (job_.stop.load() && begun_ > 1) return false;
  sum_.add(image);
  ++counted_;
  const std::lock_guard lock(mutex_);
  reported_passes_ = counted_;
  return true;
}

void Passes::pixels_done(std::size_t pixels) {
  if (!job_.report) return;
  const RenderOptions& options = job_.options;
  const std::lock_guard lock(mutex_);
  done_ += static_cast<double>(pixels) / (static_cast<double>(options.width) * options.height);
  const double now = watch_.seconds();
  double share = 0.0, left = std::numeric_limits<double>::infinity();
  if (options.passes > 0) {
    share = done_ / static_cast<double>(options.passes);
    left = now * (1.0 / share - 1.0);
  }
  if (options.seconds) {
    const double spent = job_.elapsed + job_.watch.seconds();
    share = std::min(1.0, std::max(share, spent / *options.seconds));
    left = std::min(left, std::max(0.0, *options.seconds - spent));
  }
  job_.report({share, left, reported_passes_});
}

}  // namespace lantern
