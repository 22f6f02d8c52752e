// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube_matrix.h"

#include "lantern/radiosity/direct_light.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// Standard error that may be left in what comes straight from emitters, relative to the
/// irradiance.
constexpr double kError = 0.03;
/// Of an element's edges, one hemicube for each part.
constexpr int kMostDivisions = 4;
/// Of one that is covered in part, so that what is seen from one point of it is not all.
constexpr int kDivisionsAtFoot = 2;

/// Into how many parts elements are cut, and what tells it.
class Closeness {
 public:
  Closeness(const World& world, const Tracer& tracer, const Patches& patches, double pixels)
      : patches_(patches), direct_(direct_light(world, tracer, patches)), pixels_(pixels) {}

  /// `row` is what the element sees from its centre.
  int divisions(std::size_t element, const FormFactorRow& row) const {
    const double exposed = patches_.exposed[element];
    const int least = exposed > 0.0 && exposed < 1.0 ? kDivisionsAtFoot : 1;
    const DirectLight& light = direct_[element];
    if (!(light.irradiance > 0.0)) return least;
    // How many pixels fall on a shape of so many varies by the root of those on its border.
    const double variance_of_pixels = std::pow(light.form_factor * pixels_, -1.5);
    // As if each point saw all of the light or nothing.
    const double variance_of_points = (1.0 - light.seen) / light.seen;
    const double weight = light.irradiance / (light.irradiance + reflected(row));
    const double error = weight * std::sqrt(variance_of_pixels + variance_of_points);
    int divisions = least;
    while (divisions < kMostDivisions && error > kError * divisions) divisions *= 2;
    return divisions;
  }

 private:
  /// What comes by way of one reflection.
  double reflected(const FormFactorRow& row) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < row.elements.size(); ++k) {
      const std::uint32_t e = row.elements[k];
      const glm::dvec3 rho = patches_.reflectance[patches_.patch[e]];
      sum += row.factors[k] * (rho.r + rho.g + rho.b) / 3.0 * direct_[e].irradiance;
    }
    return sum;
  }

  const Patches& patches_;
  std::vector<DirectLight> direct_;
  double pixels_;  // of a hemicube
};

}  // namespace

HemicubeMatrix hemicube_matrix(const World& world, const Tracer& tracer, const Patches& patches,
                               const HemicubeOptions& options, const StopFlag& stop,
                               const std::function<void(double)>& report) {
  const std::size_t n = patches.elements();
  std::vector<float> values(n * n, 0.0f);
  HemicubeRows hemicubes(world, tracer, patches, options);
  const Closeness closeness(world, tracer, patches,
                            static_cast<double>(hemicubes.cubes().front().size()));
  std::size_t drawn = 0;
  // Rows between two reports, and between two looks at the stop flag.
  constexpr std::size_t kRows = 64;
  std::vector<FormFactorRow> rows(kRows);
  for (std::size_t begin = 0; begin < n && !stop.load(); begin += kRows) {
    const std::size_t count = std::min(kRows, n - begin);
    hemicubes.from_centres(begin, std::span(rows).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const int divisions = closeness.divisions(begin + i, rows[i]);
      drawn += static_cast<std::size_t>(divisions * divisions);
      if (divisions == 1) continue;
      hemicubes.from_parts(static_cast<std::uint32_t>(begin + i), divisions, rows[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      float* const row = values.data() + (begin + i) * n;
      for (std::size_t k = 0; k < rows[i].elements.size(); ++k) {
        row[rows[i].elements[k]] = static_cast<float>(rows[i].factors[k]);
      }
    }
    if (report) report(static_cast<double>(begin + count) / static_cast<double>(n));
  }
  return {FormFactors(std::move(values)), drawn};
}

}  // namespace lantern
