// SPDX-License-Identifier: MIT
// Pass after pass until the options, the time or the stop flag end them; the mean of those that
// count; and reports of how far it is.
#pragma once

#include "lantern/image/accumulation.h"
#include "lantern/pipeline/render_job.h"

#include <cstddef>
#include <mutex>

namespace lantern {

/// for (Passes passes(job); passes.next();) { make pass number passes.number(); passes.add(image);
/// }
class Passes {
 public:
  explicit Passes(const RenderJob& job);

  /// Whether another pass is to be made: never one that is expected to end too late.
  bool next();
  /// Of the pass under way, counted from 0.
  std::size_t number() const { return begun_ - 1; }
  /// Takes the picture of the pass, whole or, of the first alone, as far as it came before a stop.
  /// False: it was stopped and does not count.
  bool add(const Image& image);
  Image mean() const { return sum_.mean(); }
  std::size_t count() const { return counted_; }

  /// Reports that so many more pixels of the pass are done. From any thread.
  void pixels_done(std::size_t pixels);

 private:
  const RenderJob& job_;
  Stopwatch watch_;
  Accumulation sum_;
  std::size_t begun_ = 0;
  std::size_t counted_ = 0;
  std::mutex mutex_;  // of what follows
  double done_ = 0.0;
  std::size_t reported_passes_ = 0;
};

}  // namespace lantern
