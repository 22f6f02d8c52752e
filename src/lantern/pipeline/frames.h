// SPDX-License-Identifier: MIT
// How the time of a GL frame grows with the lights and with the triangles, as the seed's analysis
// has it: frames measured, the straight line through them, a table (CSV) and a plot (SVG). A frame
// is one sample of each pixel and stays on the GPU. [Keller 1997, section 5: linear in the lights]
#pragma once

#include "lantern/core/math.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/pipeline/render.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lantern {

/// What is varied while the other stays.
enum class FrameCost { kLights, kTriangles };

/// Frames to measure.
struct FrameRun {
  std::string shadows;  // their name in tables
  FrameCost cost = FrameCost::kLights;
  std::uint32_t pieces = 1;  // each triangle is cut into pieces x pieces
  RenderOptions options;     // size, camera and what only GL knows
};

/// The fastest of some frames, in each of the measures: others only had to wait more.
struct FramePoint {
  FrameRun run;
  std::size_t lights = 0;
  std::size_t triangles = 0;
  std::size_t frames = 0;
  double seconds = 0.0;
  double processor_seconds = 0.0;     // of all threads together; Mesa draws on the processor
  std::optional<double> gpu_seconds;  // none without timers

  double varied() const {
    return static_cast<double>(run.cost == FrameCost::kLights ? lights : triangles);
  }
};

/// Draws the frame again and again for `seconds`, three times at least, after one that does not
/// count. Throws Error where no GL is usable, as GlGather does.
FramePoint measure_frames(const Scene& scene, const FrameRun& run, const VirtualLights& lights,
                          double seconds, const StopFlag& stop);

/// y = at_0 + slope x.
struct Line {
  double at_0 = 0.0;
  double slope = 0.0;
  double r_squared = 1.0;  // share of y's variance that the line explains
};

/// By least squares; none unless two x differ.
std::optional<Line> fit_line(std::span<const glm::dvec2> points);

/// A line of names, then a line a point.
std::string to_csv(std::span<const FramePoint> points);

/// Frames per second and milliseconds a frame over the lights, and over the triangles; what was not
/// measured is left out.
std::string to_svg(std::span<const FramePoint> points, const std::string& scene);

}  // namespace lantern
