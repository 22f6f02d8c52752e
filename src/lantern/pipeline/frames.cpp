// SPDX-License-Identifier: MIT
#include "lantern/pipeline/frames.h"

#include "lantern/pipeline/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

namespace lantern {
namespace {

constexpr double kMilliseconds = 1e3;

const char* name(FrameCost cost) { return cost == FrameCost::kLights ? "lights" : "triangles"; }

Plot plot_of(std::span<const FramePoint> points, FrameCost cost, const std::string& title,
             const std::function<double(const FramePoint&)>& value) {
  Plot plot;
  plot.title = title;
  plot.x_label = name(cost);
  for (const FramePoint& point : points) {
    if (point.run.cost != cost) continue;
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const Series& s) { return s.name == point.run.shadows; });
    if (series == plot.series.end()) {
      series = plot.series.insert(series, {point.run.shadows, {}});
    }
    series->points.emplace_back(point.varied(), value(point));
  }
  return plot;
}

}  // namespace

std::optional<Line> fit_line(std::span<const glm::dvec2> points) {
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const glm::dvec2& p : points) {
    const glm::dvec2 d = p - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  if (!(xx > 0.0)) return std::nullopt;
  const double slope = xy / xx;
  return Line{.at_0 = mean.y - slope * mean.x,
              .slope = slope,
              .r_squared = yy > 0.0 ? xy * xy / (xx * yy) : 1.0};
}

std::string to_csv(std::span<const FramePoint> points) {
  std::string out =
      "shadows,varied,lights,triangles,frames,frames_per_second,milliseconds,"
      "processor_milliseconds,gpu_milliseconds\n";
  for (const FramePoint& p : points) {
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{:.6g},{:.6g},{:.6g},{}\n",
                   p.run.shadows, name(p.run.cost), p.lights, p.triangles, p.frames,
                   1.0 / p.seconds, kMilliseconds * p.seconds, kMilliseconds * p.processor_seconds,
                   p.gpu_seconds ? fmt::format("{:.6g}", kMilliseconds * *p.gpu_seconds) : "");
  }
  return out;
}

std::string to_svg(std::span<const FramePoint> points, const std::string& scene) {
  std::vector<Plot> plots;
  for (const FrameCost cost : {FrameCost::kLights, FrameCost::kTriangles}) {
    Plot rate = plot_of(points, cost, fmt::format("{}: frames over the {}", scene, name(cost)),
                        [](const FramePoint& p) { return 1.0 / p.seconds; });
    if (rate.series.empty()) continue;
    rate.y_label = "frames per second";
    Plot time =
        plot_of(points, cost, fmt::format("{}: processor time over the {}", scene, name(cost)),
                [](const FramePoint& p) { return kMilliseconds * p.processor_seconds; });
    time.y_label = "ms of all processors a frame";
    time.legend = LegendCorner::kLowerRight;
    plots.push_back(std::move(rate));
    plots.push_back(std::move(time));
  }
  return to_svg(plots);
}

}  // namespace lantern
