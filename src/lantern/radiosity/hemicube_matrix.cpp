// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube_matrix.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// Standard error that pixels may leave in what comes straight from emitters, relative to the
/// irradiance.
constexpr double kError = 0.015;
/// Of an element that is covered in part, so that what is seen from one point of it is not all.
constexpr std::size_t kPointsAtFoot = 4;
constexpr std::size_t kMostPoints = 16;

/// Where light leaves by itself.
struct Source {
  glm::dvec3 centre, normal;
  double area;
  double radiosity;  // sum of the channels
};

std::vector<Source> sources_of(const Patches& patches) {
  std::vector<Source> sources;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    const glm::dvec3 emission = patches.emission[e];
    if (emission == glm::dvec3(0.0)) continue;
    sources.push_back({patches.centre[patches.patch[e]], patches.element_normal(e),
                       patches.exposed_area(e), emission.r + emission.g + emission.b});
  }
  return sources;
}

/// As if the flux of all sources came to all elements alike: what the ambient term of progressive
/// refinement is at its start, all channels reflected like their mean.
double mean_irradiance(const Patches& patches, std::span<const Source> sources) {
  double area = 0.0, reflected = 0.0, flux = 0.0;
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    const glm::dvec3 rho = patches.reflectance[patches.patch[e]];
    area += patches.exposed_area(e);
    reflected += patches.exposed_area(e) * (rho.r + rho.g + rho.b) / 3.0;
  }
  for (const Source& source : sources) flux += source.area * source.radiosity;
  return flux > 0.0 ? flux / (area - reflected) : 0.0;
}

}  // namespace

std::vector<std::size_t> hemicube_points(const Patches& patches, int resolution) {
  const std::vector<Source> sources = sources_of(patches);
  const double mean = mean_irradiance(patches, sources);
  const double pixels_of_all = 3.0 * resolution * resolution;
  std::vector<std::size_t> points(patches.elements(), 1);
  constexpr std::size_t kGrain = 64;
  parallel_for(points.size(), kGrain, [&](std::size_t e) {
    const double exposed = patches.exposed[e];
    if (exposed > 0.0 && exposed < 1.0) points[e] = kPointsAtFoot;
    const glm::dvec3 centre = patches.centre[patches.patch[e]], normal = patches.element_normal(e);
    double factor = 0.0, direct = 0.0;
    for (const Source& source : sources) {
      const glm::dvec3 way = source.centre - centre;
      const double square = glm::dot(way, way);
      const double here = glm::dot(way, normal), there = -glm::dot(way, source.normal);
      if (here <= 0.0 || there <= 0.0) continue;
      const double share = source.area * here * there / (std::numbers::pi * square * square);
      factor += share;
      direct += share * source.radiosity;
    }
    if (!(factor > 0.0)) return;
    // How many pixels fall on a shape of so many varies by the root of those on its border.
    const double variance = std::pow(factor * pixels_of_all, -1.5);
    const double weight = direct / std::max(direct, mean);
    const double wanted = std::ceil(weight * weight * variance / (kError * kError));
    points[e] = std::max(
        points[e], static_cast<std::size_t>(std::min(wanted, static_cast<double>(kMostPoints))));
  });
  return points;
}

FormFactors hemicube_form_factors(const World& world, const Tracer& tracer, const Patches& patches,
                                  const HemicubeOptions& options, const StopFlag& stop,
                                  const std::function<void(double)>& report) {
  const std::size_t n = patches.elements();
  std::vector<float> values(n * n, 0.0f);
  HemicubeRows hemicubes(world, tracer, patches, options);
  const std::vector<std::size_t> points = hemicube_points(patches, options.resolution);
  // Rows between two reports, and between two looks at the stop flag.
  constexpr std::size_t kRows = 64;
  std::vector<FormFactorRow> rows(kRows);
  for (std::size_t begin = 0; begin < n && !stop.load(); begin += kRows) {
    const std::size_t count = std::min(kRows, n - begin);
    hemicubes.from_centres(begin, std::span(rows).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t e = begin + i;
      if (points[e] == 1) continue;
      hemicubes.from_points(static_cast<std::uint32_t>(e), {.count = points[e]}, rows[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      float* const row = values.data() + (begin + i) * n;
      for (std::size_t k = 0; k < rows[i].elements.size(); ++k) {
        row[rows[i].elements[k]] = static_cast<float>(rows[i].factors[k]);
      }
    }
    if (report) report(static_cast<double>(begin + count) / static_cast<double>(n));
  }
  return FormFactors(std::move(values));
}

}  // namespace lantern
