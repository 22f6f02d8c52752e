// SPDX-License-Identifier: MIT
// Parallel loops and the number of threads they run on (oneTBB). A loop body writes only what
// belongs to its index, so results never depend on the number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace lantern {

/// While it lives, parallel loops of the process use at most `threads` threads (0: all cores).
/// More threads than cores are honoured, so that tests can show that the count does not matter.
class ThreadScope {
 public:
  explicit ThreadScope(int threads);
  ~ThreadScope();
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

  /// Runs `work` inside the arena of this scope.
  void run(const std::function<void()>& work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Calls body(i) for every i in [0, count), in chunks of at least `grain` consecutive indices.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body);

/// Set from another thread or a signal handler to end long work early.
using StopFlag = std::atomic<bool>;
static_assert(StopFlag::is_always_lock_free, "a signal handler sets it");

}  // namespace lantern
