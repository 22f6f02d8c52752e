// SPDX-License-Identifier: MIT
#include "lantern/pipeline/convergence.h"

#include "lantern/pipeline/plot.h"
#include "lantern/pipeline/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lantern {
namespace {

const char* name(Effort effort) { return effort == Effort::kSeconds ? "seconds" : "lights"; }

/// A series per method, in the order in which they first appear.
Plot plot_of(std::span<const ConvergencePoint> points, Effort effort, const std::string& scene) {
  Plot plot;
  plot.title = effort == Effort::kSeconds ? scene + ": error over time"
                                          : scene + ": error over the lights of one pass";
  plot.x_label = name(effort);
  plot.y_label = "relmse";
  for (const ConvergencePoint& point : points) {
    if (point.run.effort != effort) continue;
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const Series& s) { return s.name == point.run.method; });
    if (series == plot.series.end()) {
      series = plot.series.insert(series, {point.run.method, {}});
    }
    const double x =
        effort == Effort::kSeconds ? point.seconds : static_cast<double>(point.statistics.lights);
    series->points.emplace_back(x, point.error.relmse);
  }
  return plot;
}

}  // namespace

ConvergencePoint measure(const Scene& scene, const ConvergenceRun& run, const Image& reference,
                         const FlipOptions& flip_with, const StopFlag& stop) {
  ConvergencePoint point;
  point.run = run;
  point.run.options.width = reference.width;
  point.run.options.height = reference.height;
  const double processor_before = processor_seconds();
  const Stopwatch watch;
  const Rendered rendered = render(scene, point.run.options, stop);
  point.seconds = watch.seconds();
  point.processor_seconds = processor_seconds() - processor_before;
  point.statistics = rendered.statistics;
  point.error = compare(rendered.image, reference);
  point.flip = flip(rendered.image, reference, flip_with).mean;
  return point;
}

std::string to_csv(std::span<const ConvergencePoint> points) {
  std::string out =
      "method,effort,asked,seconds,processor_seconds,passes,lights,rmse,relmse,flip,"
      "mean_r,mean_g,mean_b,reference_r,reference_g,reference_b\n";
  for (const ConvergencePoint& p : points) {
    const Comparison& e = p.error;
    fmt::format_to(std::back_inserter(out),
                   "{},{},{:g},{:.4f},{:.4f},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},"
                   "{:.6g},{:.6g},{:.6g}\n",
                   p.run.method, name(p.run.effort), p.run.asked, p.seconds, p.processor_seconds,
                   p.statistics.passes, p.statistics.lights, e.rmse, e.relmse, p.flip, e.mean_a.r,
                   e.mean_a.g, e.mean_a.b, e.mean_b.r, e.mean_b.g, e.mean_b.b);
  }
  return out;
}

std::string to_svg(std::span<const ConvergencePoint> points, const std::string& scene) {
  std::vector<Plot> plots;
  for (const Effort effort : {Effort::kSeconds, Effort::kLights}) {
    Plot plot = plot_of(points, effort, scene);
    if (!plot.series.empty()) plots.push_back(std::move(plot));
  }
  return to_svg(plots);
}

}  // namespace lantern
