// SPDX-License-Identifier: MIT
// Patches -> radiosities, best first: the element with the most unshot flux sends it to all that
// its hemicubes see, until little is left. After every shot what is there is a picture, together
// with an ambient term for the light still to come. [Cohen, Chen, Wallace & Greenberg 1988, A
// Progressive Refinement Approach to Fast Radiosity Image Generation]
#pragma once

#include "lantern/radiosity/hemicube_rows.h"
#include "lantern/radiosity/patches.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

struct ProgressiveOptions {
  double cutoff = 1e-4;  // shooting ends when no more than this share of the flux emitted is unshot
  HemicubeOptions hemicube = {};
};

/// Flux in W per channel. At any moment all that was emitted is absorbed, escaped or unshot.
struct FluxBalance {
  glm::dvec3 emitted{0.0};
  glm::dvec3 absorbed{0.0};
  glm::dvec3 escaped{0.0};
  glm::dvec3 unshot{0.0};

  /// Of the channel where it is largest, relative to the flux emitted.
  double error() const;
};

class ProgressiveRadiosity {
 public:
  /// As HemicubeRows takes them. `direct` is the irradiance of each element, in W/m², by lights
  /// that are no patches (points, the sun, the sky); empty if there are none.
  ProgressiveRadiosity(const World& world, const Tracer& tracer, const Patches& patches,
                       const ProgressiveOptions& options,
                       std::span<const glm::dvec3> external = {});

  /// The element with the most unshot flux shoots it, from as many points and by as fine hemicubes
  /// as keep every pixel's flux small; if they are very many only a part of it, so that no shot
  /// takes long. False: nothing was left to shoot.
  bool shoot();

  std::size_t shots() const { return shots_; }
  std::size_t hemicubes() const { return hemicubes_; }
  /// Of the flux emitted, over all channels. Never grows.
  double unshot_share() const { return unshot_share_; }
  FluxBalance balance() const;

  /// W/m² per channel of each element, what came so far; then reflected it is radiosity, with the
  /// element's own emission.
  std::vector<glm::dvec3> irradiance() const;
  /// An estimate of the irradiance still to come, the same everywhere: mean radiosity unshot, with
  /// all its reflections in a room of mean reflectance. [Cohen et al. 1988, equations 5 to 8]
  glm::dvec3 ambient() const;

 private:
  HemicubeRows::Points points_for(double flux) const;
  void look_for_next();

  const Patches& patches_;
  ProgressiveOptions options_;
  HemicubeRows rows_;
  // Per element.
  std::vector<double> area_;
  std::vector<glm::dvec3> reflectance_;
  std::vector<glm::dvec3> unshot_;
  std::vector<glm::dvec3> received_;
  std::vector<double> order_;               // sum of the channels of `unshot_`
  std::vector<std::uint64_t> points_used_;  // of its sequence
  glm::dvec3 emitted_{0.0};
  glm::dvec3 escaped_{0.0};
  std::size_t shots_ = 0;
  std::size_t hemicubes_ = 0;
  double unshot_share_ = 0.0;
  std::size_t next_ = 0;  // the element with the most unshot flux
  FormFactorRow row_;
};

}  // namespace lantern
