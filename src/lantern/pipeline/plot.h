// SPDX-License-Identifier: MIT
// Lines over two logarithmic axes as an SVG picture of its own: ticks, a legend, colours that most
// eyes tell apart. Points that are not positive and finite have no place on such axes and are left
// out; a plot may be empty.
#pragma once

#include "lantern/core/math.h"

#include <span>
#include <string>
#include <vector>

namespace lantern {

struct Series {
  std::string name;
  std::vector<glm::dvec2> points;  // joined in this order
};

enum class LegendCorner { kLowerLeft, kLowerRight };

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  LegendCorner legend =
      LegendCorner::kLowerLeft;  // where what falls leaves room; kLowerRight: rises
};

/// The plots side by side.
std::string to_svg(std::span<const Plot> plots);

}  // namespace lantern
