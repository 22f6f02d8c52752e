// SPDX-License-Identifier: MIT
// Nanoseconds per value of a point set, for indices below 2^20.
#include "lantern/sampling/halton.h"

#include <benchmark/benchmark.h>

namespace lantern {
namespace {

constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << 20) - 1;

void point_set(benchmark::State& state, Sampler sampler) {
  const PointSet points{sampler, 0};
  const auto dimension = static_cast<int>(state.range(0));
  std::uint64_t index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(points.at(index++ & kIndexMask, dimension));
  }
}
BENCHMARK_CAPTURE(point_set, plain, Sampler::kHalton)->DenseRange(0, 3);
BENCHMARK_CAPTURE(point_set, scrambled, Sampler::kScrambled)
    ->DenseRange(0, 4)
    ->Arg(10)
    ->Arg(16)
    ->Arg(20);
BENCHMARK_CAPTURE(point_set, random, Sampler::kRandom)->Arg(0);

void incremental(benchmark::State& state) {
  IncrementalRadicalInverse points(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(points.value());
    points.next();
  }
}
BENCHMARK(incremental)->Arg(2)->Arg(3);

}  // namespace
}  // namespace lantern
