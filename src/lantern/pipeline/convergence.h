// SPDX-License-Identifier: MIT
// How the error of a method falls with the time it is given, or with the lights: renders measured
// against a reference picture, as a table (CSV) and as a plot (SVG). Times are those of render()
// alone, without loading. Errors: Error as render() and compare() give.
#pragma once

#include "lantern/image/compare.h"
#include "lantern/image/flip.h"
#include "lantern/pipeline/render.h"

#include <span>
#include <string>
#include <vector>

namespace lantern {

/// What is varied.
enum class Effort { kSeconds, kLights };

/// One render to measure.
struct ConvergenceRun {
  std::string method;  // its name in tables
  Effort effort = Effort::kSeconds;
  double asked = 0.0;  // seconds, or lights' paths of the one pass
  RenderOptions options;
};

struct ConvergencePoint {
  ConvergenceRun run;
  double seconds = 0.0;
  double processor_seconds = 0.0;  // of all threads together
  RenderStatistics statistics;
  Comparison error;
  double flip = 0.0;
};

/// Renders and compares; the picture has the size of the reference.
ConvergencePoint measure(const Scene& scene, const ConvergenceRun& run, const Image& reference,
                         const FlipOptions& flip_with, const StopFlag& stop);

/// A line of names, then a line a point.
std::string to_csv(std::span<const ConvergencePoint> points);

/// relmse over seconds, and over lights beside it; a plot without points is left out.
std::string to_svg(std::span<const ConvergencePoint> points, const std::string& scene);

}  // namespace lantern
