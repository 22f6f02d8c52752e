// SPDX-License-Identifier: MIT
#include "lantern/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace lantern {
namespace {

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

void ThreadScope::run(const std::function<void()>& work) { state_->arena.execute(work); }

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                    });
}

}  // namespace lantern
