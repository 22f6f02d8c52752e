// SPDX-License-Identifier: MIT
#include "lantern/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef LANTERN_UNSEEN_THREADS
#include <sanitizer/tsan_interface.h>
#endif

namespace lantern {
namespace {

/// The thread sanitizer sees nothing of what TBB does, so this file is built without it and tells
/// it of the fork and the join of each loop. Races between the bodies themselves stay in its sight.
class ForkJoin {
 public:
#ifdef LANTERN_UNSEEN_THREADS
  ForkJoin() { __tsan_release(&fork_); }
  ~ForkJoin() { __tsan_acquire(&join_); }
  void begin() { __tsan_acquire(&fork_); }
  void end() { __tsan_release(&join_); }

 private:
  char fork_ = 0, join_ = 0;
#else
  void begin() {}
  void end() {}
#endif
};

int count_or_cores(int threads) { return threads > 0 ? threads : tbb::info::default_concurrency(); }

}  // namespace

struct ThreadScope::State {
  explicit State(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads) {}
  tbb::global_control control;
  tbb::task_arena arena;
};

ThreadScope::ThreadScope(int threads) : state_(std::make_unique<State>(count_or_cores(threads))) {}
ThreadScope::~ThreadScope() = default;

void ThreadScope::run(const std::function<void()>& work) {
  ForkJoin order;
  state_->arena.execute([&] {
    order.begin();
    work();
    order.end();
  });
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body) {
  ForkJoin order;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      order.begin();
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      order.end();
                    });
}

}  // namespace lantern
