// SPDX-License-Identifier: MIT
#include "lantern/pipeline/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace lantern {
namespace {

// Pixels of one plot and of the area inside its axes.
constexpr double kWidth = 520.0, kHeight = 420.0;
constexpr double kLeft = 70.0, kRight = 20.0, kTop = 40.0, kBottom = 56.0;
constexpr double kLegendLine = 18.0;

/// Colours that the colour-blind can tell apart [Okabe & Ito 2008], the yellow left out: it is too
/// pale on white.
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

bool has_place(const glm::dvec2& p) {
  return p.x > 0.0 && p.y > 0.0 && std::isfinite(p.x) && std::isfinite(p.y);
}

struct Tick {
  double value;
  bool labelled;
};

/// A logarithmic axis from one pixel to another.
class Axis {
 public:
  Axis(double first_pixel, double last_pixel) : first_(first_pixel), last_(last_pixel) {}

  void add(double value) {
    low_ = std::min(low_, std::log10(value));
    high_ = std::max(high_, std::log10(value));
  }
  /// Widens the axis to round numbers.
  void finish() {
    if (low_ > high_) low_ = high_ = 0.0;
    // A little room, so that no point lies on the frame.
    constexpr double kRoom = 0.02;
    low_ = round_down(low_ - kRoom);
    high_ = round_up(high_ + kRoom);
  }
  double pixel(double value) const {
    return first_ + (std::log10(value) - low_) / (high_ - low_) * (last_ - first_);
  }
  /// 1 to 9 times each power of ten inside; long axes name the powers, short ones 2 and 5 as well.
  std::vector<Tick> ticks() const {
    constexpr double kLong = 2.5;  // decades
    constexpr double kSlack = 1e-9;
    std::vector<Tick> ticks;
    for (double decade = std::floor(low_); decade <= high_; decade += 1.0) {
      for (int i = 1; i <= 9; ++i) {
        const double value = i * std::pow(10.0, decade), place = std::log10(value);
        if (place < low_ - kSlack || place > high_ + kSlack) continue;
        ticks.push_back({value, i == 1 || (high_ - low_ < kLong && (i == 2 || i == 5))});
      }
    }
    return ticks;
  }

 private:
  // To the next of 1, 2 and 5 times a power of ten; logarithms in and out.
  static double round_down(double log) {
    const double decade = std::floor(log);
    for (const double step : {5.0, 2.0}) {
      if (decade + std::log10(step) <= log) return decade + std::log10(step);
    }
    return decade;
  }
  static double round_up(double log) {
    const double decade = std::floor(log);
    for (const double step : {1.0, 2.0, 5.0}) {
      if (decade + std::log10(step) >= log) return decade + std::log10(step);
    }
    return decade + 1.0;
  }

  double first_, last_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

std::string label(double value) {
  constexpr double kPlainFrom = 0.001, kPlainTo = 10000.0;
  return value >= kPlainFrom && value <= kPlainTo ? fmt::format("{:g}", value)
                                                  : fmt::format("{:.0e}", value);
}

/// A mark of its own for each series, so that colour is not all that tells them apart.
std::string marker(std::size_t series, double x, double y) {
  constexpr double r = 4.0;
  switch (series % 4) {
    case 0:
      return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>", x, y, r);
    case 1:
      return fmt::format("<path d=\"M{:.2f} {:.2f}h{}v{}h{}z\"/>", x - r, y - r, 2 * r, 2 * r,
                         -2 * r);
    case 2:
      return fmt::format("<path d=\"M{:.2f} {:.2f}l{} {}h{}z\"/>", x, y - 1.2 * r, 1.2 * r, 2.1 * r,
                         -2.4 * r);
    default:
      return fmt::format("<path d=\"M{:.2f} {:.2f}l{r} {r}l-{r} {r}l-{r} -{r}z\"/>", x, y - 1.3 * r,
                         fmt::arg("r", 1.3 * r));
  }
}

void draw(const Plot& plot, double left, std::string& out) {
  const auto to = std::back_inserter(out);
  const double x0 = left + kLeft, x1 = left + kWidth - kRight;
  const double y0 = kTop, y1 = kHeight - kBottom;
  Axis x(x0, x1), y(y1, y0);
  for (const Series& series : plot.series) {
    for (const glm::dvec2& point : series.points) {
      if (!has_place(point)) continue;
      x.add(point.x);
      y.add(point.y);
    }
  }
  x.finish();
  y.finish();

  fmt::format_to(to, "<text x=\"{:.2f}\" y=\"22\" class=\"title\">{}</text>\n", 0.5 * (x0 + x1),
                 escaped(plot.title));
  const auto line = [&](double xa, double ya, double xb, double yb, bool labelled) {
    fmt::format_to(to, "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" class=\"{}\"/>\n", xa, ya, xb, yb,
                   labelled ? "major" : "minor");
  };
  for (const Tick& tick : x.ticks()) {
    const double at = x.pixel(tick.value);
    line(at, y0, at, y1, tick.labelled);
    if (!tick.labelled) continue;
    fmt::format_to(to, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"x\">{}</text>\n", at, y1 + 17.0,
                   label(tick.value));
  }
  for (const Tick& tick : y.ticks()) {
    const double at = y.pixel(tick.value);
    line(x0, at, x1, at, tick.labelled);
    if (!tick.labelled) continue;
    fmt::format_to(to, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"y\">{}</text>\n", x0 - 7.0,
                   at + 4.0, label(tick.value));
  }
  fmt::format_to(to, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n", x0,
                 y0, x1 - x0, y1 - y0);
  fmt::format_to(to, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"x\">{}</text>\n", 0.5 * (x0 + x1),
                 kHeight - 18.0, escaped(plot.x_label));
  const double label_x = left + 18.0, label_y = 0.5 * (y0 + y1);
  fmt::format_to(to,
                 "<text x=\"{0:.2f}\" y=\"{1:.2f}\" class=\"x\" transform=\"rotate(-90 {0:.2f} "
                 "{1:.2f})\">{2}</text>\n",
                 label_x, label_y, escaped(plot.y_label));

  constexpr double kLegendWidth = 140.0;
  const double legend_x = plot.legend == LegendCorner::kLowerLeft ? x0 + 16.0 : x1 - kLegendWidth;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const char* colour = kColours[i % kColours.size()];
    std::string joined, marks;
    for (const glm::dvec2& point : series.points) {
      if (!has_place(point)) continue;
      joined += fmt::format("{}{:.2f} {:.2f}", joined.empty() ? "M" : "L", x.pixel(point.x),
                            y.pixel(point.y));
      marks += marker(i, x.pixel(point.x), y.pixel(point.y));
    }
    fmt::format_to(to, "<g fill=\"{0}\">\n", colour);
    if (!joined.empty()) {
      fmt::format_to(to, "<path d=\"{}\" class=\"line\" stroke=\"{}\"/>\n{}\n", joined, colour,
                     marks);
    }
    const double row = y1 - 14.0 - kLegendLine * static_cast<double>(plot.series.size() - 1 - i);
    fmt::format_to(to, "{}<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"legend\">{}</text>\n</g>\n",
                   marker(i, legend_x, row), legend_x + 12.0, row + 4.0, escaped(series.name));
  }
}

}  // namespace

std::string to_svg(std::span<const Plot> plots) {
  const double width = kWidth * static_cast<double>(std::max<std::size_t>(plots.size(), 1));
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\">\n"
      "<style>text{{font:12px sans-serif;fill:#222}}.title{{font-size:14px;text-anchor:middle}}"
      ".x{{text-anchor:middle}}.y{{text-anchor:end}}.legend{{text-anchor:start}}"
      ".minor{{stroke:#eee}}.major{{stroke:#ccc}}.frame{{fill:none;stroke:#222}}"
      ".line{{fill:none;stroke-width:2}}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, kHeight);
  for (std::size_t i = 0; i < plots.size(); ++i)
    draw(plots[i], kWidth * static_cast<double>(i), out);
  return out + "</svg>\n";
}

}  // namespace lantern
