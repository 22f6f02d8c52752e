// SPDX-License-Identifier: MIT
// Patches of a traced world -> rows of form factors, by hemicubes that stand on
// the patches: shares of what leaves an element that come to the others. Each hemicube is turned
// about its normal by a hash, so that no two alias alike. [Cohen & Greenberg 1985, The Hemi-Cube]
#pragma once

#include "lantern/radiosity/hemicube.h"
#include "lantern/radiosity/patch_locator.h"
#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// The form factors from an element that are not zero; with `escaped` their sum is 1.
struct FormFactorRow {
  std::vector<std::uint32_t> elements;  // each once
  std::vector<double> factors;
  double escaped = 0.0;  // out of the scene, or through a gap to where no element is
};

struct HemicubeOptions {
  int resolution = 64;                 // pixels along the top's edge of the finest, see hemicube.h
  std::uint64_t seed = 0;              // other turns, other points
  HemicubePainter* painter = nullptr;  // for the finest; none: rays
};

/// Its buffers serve all of its calls: one call at a time.
class HemicubeRows {
 public:
  /// Keeps references; the patches are those of `world`, as `tracer` is.
  HemicubeRows(const World& world, const Tracer& tracer, const Patches& patches,
               const HemicubeOptions& options);

  /// The one of the given resolution first, then as often as it can be halved down to 16 pixels
  /// coarser ones.
  std::span<const Hemicube> cubes() const { return cubes_; }

  /// From the centres of the elements [first, first + rows.size()), by the finest hemicube.
  void from_centres(std::size_t first, std::span<FormFactorRow> rows);

  /// The mean of the rows from the centres of `divisions` squared equal parts of an element: as a
  /// rule of integration it is as exact as the centre is, to first order, and finer.
  void from_parts(std::uint32_t element, int divisions, FormFactorRow& row);

  struct Points {
    std::uint64_t first = 0;  // numbers of a sequence that covers the element evenly
    std::size_t count = 1;
    std::size_t cube = 0;  // of cubes()
  };
  /// The mean of the rows from these points.
  void from_points(std::uint32_t element, const Points& points, FormFactorRow& row);

 private:
  /// Sums of one row, dense while it grows.
  struct Sum {
    std::vector<double> of_element;
    std::vector<std::uint32_t> met;
    double escaped = 0.0;
    std::size_t hemicubes = 0;
  };

  HemicubeView view(std::uint32_t element, const glm::dvec3& position, std::uint64_t turn) const;
  HemicubeView view_from_centre(std::uint32_t element) const;
  HemicubeView view_from_point(std::uint32_t element, std::uint64_t number) const;
  HemicubeView view_at(std::uint32_t element, const glm::dvec2& weights, std::uint64_t turn) const;
  std::uint32_t item(const Hit& hit, const Vec3& direction) const;
  void draw(const Hemicube& cube, std::span<const HemicubeView> views);
  void paint(const Hemicube& cube, std::span<const HemicubeView> views);
  void add(const Hemicube& cube, std::size_t number, Sum& sum) const;
  void add_uncovered_point(const Hemicube& cube, std::uint32_t element, std::uint64_t first,
                           Sum& sum);
  void take(Sum& sum, FormFactorRow& row) const;

  const Tracer& tracer_;
  const Patches& patches_;
  PatchLocator locator_;
  std::vector<Vec3> area_vectors_;  // of the world's triangles
  float scale_;
  std::uint64_t seed_;
  HemicubePainter* painter_;
  std::vector<Hemicube> cubes_;
  std::vector<Hit> painted_;          // of one hemicube
  std::vector<std::uint32_t> items_;  // of the hemicubes drawn last, one after the other
  std::vector<Sum> sums_;
};

}  // namespace lantern
