// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube_matrix.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lantern {

FormFactors hemicube_form_factors(const World& world, const Tracer& tracer, const Patches& patches,
                                  const HemicubeOptions& options, const StopFlag& stop,
                                  const std::function<void(double)>& report) {
  const std::size_t n = patches.elements();
  std::vector<float> values(n * n, 0.0f);
  HemicubeRows hemicubes(world, tracer, patches, options);
  // Rows between two reports, and between two looks at the stop flag.
  constexpr std::size_t kRows = 64;
  std::vector<FormFactorRow> rows(kRows);
  for (std::size_t begin = 0; begin < n && !stop.load(); begin += kRows) {
    const std::size_t count = std::min(kRows, n - begin);
    hemicubes.from_centres(begin, std::span(rows).first(count));
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
