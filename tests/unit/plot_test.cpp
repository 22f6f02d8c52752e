// SPDX-License-Identifier: MIT
#include "lantern/pipeline/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <limits>
#include <sstream>

namespace lantern {
namespace {

/// A drawing read back: an XML parser finds every element closed and every text escaped.
class Drawing {
 public:
  explicit Drawing(const std::vector<Plot>& plots) {
    const std::string svg = to_svg(plots);
    EXPECT_EQ(document_.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document_.ErrorStr();
    collect(document_.RootElement());
  }
  const std::vector<std::string>& texts() const { return texts_; }
  double width() const { return document_.RootElement()->DoubleAttribute("width"); }
  double height() const { return document_.RootElement()->DoubleAttribute("height"); }

  /// The joined points of each series, in pixels.
  const std::vector<std::vector<glm::dvec2>>& lines() const { return lines_; }
  /// Centres of the round marks, those of the first series and its entry in the legend.
  std::size_t circles() const { return circles_; }

 private:
  void collect(const tinyxml2::XMLElement* element) {
    if (!element) return;
    const std::string kind = element->Name();
    if (kind == "text") texts_.push_back(element->GetText());
    if (kind == "circle") ++circles_;
    if (kind == "path" && element->Attribute("class", "line")) {
      std::string d = element->Attribute("d");
      for (char& c : d) c = c == 'M' || c == 'L' ? ' ' : c;
      std::istringstream numbers(d);
      std::vector<glm::dvec2> points;
      for (glm::dvec2 p; numbers >> p.x >> p.y;) points.push_back(p);
      lines_.push_back(points);
    }
    for (const auto* child = element->FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      collect(child);
    }
  }

  tinyxml2::XMLDocument document_;
  std::vector<std::string> texts_;
  std::vector<std::vector<glm::dvec2>> lines_;
  std::size_t circles_ = 0;
};

TEST(Plot, EqualFactorsAreEqualSteps) {
  const Drawing drawing({{"t", "x", "y", {{"a", {{1, 1}, {10, 0.1}, {100, 0.01}, {1000, 1e-3}}}}}});
  ASSERT_EQ(drawing.lines().size(), 1u);
  const auto& p = drawing.lines()[0];
  ASSERT_EQ(p.size(), 4u);
  // Pixels are written to two decimals.
  for (std::size_t i = 2; i < 4; ++i) {
    EXPECT_NEAR(p[i].x - p[i - 1].x, p[1].x - p[0].x, 0.021);
    EXPECT_NEAR(p[i].y - p[i - 1].y, p[1].y - p[0].y, 0.021);
  }
  EXPECT_GT(p[1].x, p[0].x);
  EXPECT_GT(p[1].y, p[0].y);  // what is smaller lies lower
  EXPECT_EQ(drawing.circles(), 5u);
}

TEST(Plot, NamesWhatItShows) {
  const Drawing drawing(
      {{"Box & co", "seconds", "error < 1", {{"a", {{1, 1}}}, {"b", {{20, 0.5}}}}}});
  EXPECT_THAT(drawing.texts(),
              testing::IsSupersetOf({"Box & co", "seconds", "error < 1", "a", "b"}));
  EXPECT_THAT(drawing.texts(), testing::IsSupersetOf({"1", "2", "5", "10", "20", "0.5"}));
}

TEST(Plot, PointsLieInsideTheDrawing) {
  for (const double spread : {1.0, 1.001, 3.0, 1e9}) {
    const Drawing drawing(
        {{"t", "x", "y", {{"a", {{0.07, 7e-5}, {0.07 * spread, 7e-5 / spread}}}}}});
    for (const glm::dvec2& p : drawing.lines().at(0)) {
      EXPECT_GT(p.x, 0.0);
      EXPECT_LT(p.x, drawing.width());
      EXPECT_GT(p.y, 0.0);
      EXPECT_LT(p.y, drawing.height());
    }
  }
}

TEST(Plot, LeavesOutWhatHasNoLogarithm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Drawing drawing({{"t", "x", "y", {{"a", {{1, 0}, {2, nan}, {-1, 3}, {3, 4}, {5, 6}}}}}});
  EXPECT_EQ(drawing.lines().at(0).size(), 2u);
}

TEST(Plot, TheLegendStandsWhereItIsTold) {
  Plot plot{"t", "x", "y", {{"a", {{1, 1}, {2, 2}}}}};
  const std::string left = to_svg(std::vector{plot});
  plot.legend = LegendCorner::kLowerRight;
  const std::string right = to_svg(std::vector{plot});
  const auto place = [](const std::string& svg) {
    const std::size_t legend = svg.find("class=\"legend\"");
    return std::stod(svg.substr(svg.rfind("x=\"", legend) + 3));
  };
  EXPECT_GT(place(right), place(left));
}

TEST(Plot, MayBeEmpty) {
  EXPECT_TRUE(Drawing({}).lines().empty());
  EXPECT_TRUE(Drawing({{"t", "x", "y", {{"a", {}}}}}).lines().empty());
}

TEST(Plot, SeveralStandSideBySide) {
  const Plot plot{"t", "x", "y", {{"a", {{1, 1}, {2, 2}}}}};
  const Drawing one({plot}), two({plot, plot});
  EXPECT_EQ(two.width(), 2.0 * one.width());
  EXPECT_EQ(two.height(), one.height());
  EXPECT_NEAR(two.lines()[1][0].x, two.lines()[0][0].x + one.width(), 0.011);
  EXPECT_EQ(two.lines()[1][0].y, two.lines()[0][0].y);
}

}  // namespace
}  // namespace lantern
