// SPDX-License-Identifier: MIT
// How frame times are put into lines, tables and plots; nothing here is timed.
#include "lantern/pipeline/frames.h"

#include "lantern/core/hash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace lantern {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(FitLine, FindsALine) {
  const std::optional<Line> line = fit_line(std::vector<glm::dvec2>{{16, 35}, {64, 131}, {2, 7}});
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->at_0, 3.0, 1e-12);
  EXPECT_NEAR(line->slope, 2.0, 1e-12);
  EXPECT_NEAR(line->r_squared, 1.0, 1e-12);
}

TEST(FitLine, LeavesTheLeastSquares) {
  std::vector<glm::dvec2> points;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto x = static_cast<double>(i * i);
    points.emplace_back(x, 5.0 + 0.5 * x + 40.0 * static_cast<double>(to_unit_float(hash(i, 3u))));
  }
  const Line line = fit_line(points).value();
  const auto squares = [&](double at_0, double slope) {
    double sum = 0.0;
    for (const glm::dvec2& p : points) sum += std::pow(p.y - at_0 - slope * p.x, 2.0);
    return sum;
  };
  const double least = squares(line.at_0, line.slope);
  for (const double step : {-1e-3, 1e-3}) {
    EXPECT_GT(squares(line.at_0 + step, line.slope), least);
    EXPECT_GT(squares(line.at_0, line.slope + step), least);
  }
  // The variance that the line does not explain.
  double mean = 0.0;
  for (const glm::dvec2& p : points) mean += p.y / 20.0;
  EXPECT_NEAR(line.r_squared, 1.0 - least / squares(mean, 0.0), 1e-12);
  EXPECT_LT(line.r_squared, 1.0);
}

TEST(FitLine, NeedsTwoPlaces) {
  EXPECT_FALSE(fit_line({}));
  EXPECT_FALSE(fit_line(std::vector<glm::dvec2>{{3, 1}}));
  EXPECT_FALSE(fit_line(std::vector<glm::dvec2>{{3, 1}, {3, 2}}));
  const Line level = fit_line(std::vector<glm::dvec2>{{3, 1}, {4, 1}}).value();
  EXPECT_EQ(level.slope, 0.0);
  EXPECT_EQ(level.r_squared, 1.0);
}

FramePoint point(const char* shadows, FrameCost cost, std::size_t lights, std::size_t triangles,
                 double seconds) {
  FramePoint p;
  p.run.shadows = shadows;
  p.run.cost = cost;
  p.lights = lights;
  p.triangles = triangles;
  p.frames = 3;
  p.seconds = seconds;
  p.processor_seconds = 2.0 * seconds;
  return p;
}

TEST(Frames, WriteATable) {
  FramePoint timed = point("stencil", FrameCost::kLights, 61, 32, 0.25);
  timed.gpu_seconds = 0.125;
  const FramePoint untimed = point("interleaved", FrameCost::kTriangles, 61, 512, 0.5);
  EXPECT_EQ(to_csv(std::vector{timed, untimed}),
            "shadows,varied,lights,triangles,frames,frames_per_second,milliseconds,"
            "processor_milliseconds,gpu_milliseconds\n"
            "stencil,lights,61,32,3,4,250,500,125\n"
            "interleaved,triangles,61,512,3,2,500,1000,\n");
}

TEST(Frames, PlotOnlyWhatWasMeasured) {
  const FramePoint lights = point("stencil", FrameCost::kLights, 61, 32, 0.25);
  const FramePoint triangles = point("interleaved", FrameCost::kTriangles, 61, 512, 0.5);
  const std::string one = to_svg(std::vector{lights}, "box");
  EXPECT_THAT(one, HasSubstr("box: frames over the lights"));
  EXPECT_THAT(one, HasSubstr("box: processor time over the lights"));
  EXPECT_THAT(one, HasSubstr(">stencil<"));
  EXPECT_THAT(one, Not(HasSubstr("triangles")));
  const std::string both = to_svg(std::vector{lights, triangles}, "box");
  EXPECT_THAT(both, HasSubstr("box: frames over the triangles"));
  EXPECT_THAT(both, HasSubstr(">interleaved<"));
}

}  // namespace
}  // namespace lantern
