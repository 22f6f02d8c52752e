// SPDX-License-Identifier: MIT
// Progressive radiosity on the GPU: an element of the patches is a texel. Clusters of elements
// shoot, most flux first; an item buffer drawn on a hemicube says what each sees, and a fragment
// shader gathers the received light over all texels. Needs a current GL context. [Coombe, Harris &
// Lastra 2004, Radiosity on Graphics Hardware; docs/radiosity.md says what differs]
#pragma once

#include "lantern/radiosity/patches.h"
#include "lantern/radiosity_gl/shooter_tree.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace lantern {

struct GpuRadiosityOptions {
  int hemicube = 128;    // pixels along its top's edge, a multiple of 8
  double cutoff = 1e-3;  // shooting ends when no more than this share of the emitted flux is unshot
  ShotLimits limits = {};
  std::uint64_t seed = 0;  // other points that clusters are seen from
};

/// Flux in W per channel: all that was emitted is absorbed, lost (out of the scene, or to where no
/// element is) or unshot.
struct GpuFluxBalance {
  glm::dvec3 emitted{0.0}, absorbed{0.0}, lost{0.0}, unshot{0.0};

  /// Of the channel where it is largest, relative to the flux emitted.
  double error() const;
};

class GpuRadiosity {
 public:
  /// Keeps a reference to `patches`. `external` is the irradiance in W/m² that lights without area
  /// bring each element. Throws Error where this GL cannot do it: no floats to blend into, too
  /// small textures.
  GpuRadiosity(const World& world, const Tracer& tracer, const Patches& patches,
               std::span<const glm::dvec3> external, const GpuRadiosityOptions& options);
  ~GpuRadiosity();

  /// One cluster shoots, or a part of one. False: what is unshot is below the cutoff.
  bool shoot();

  std::size_t shots() const;
  /// Of the emitted flux, over all channels; never grows. Like the balance it is known at the ends
  /// of rounds: a round shoots clusters of similar flux, whose light is shot again from the next
  /// on.
  double unshot_share() const;
  GpuFluxBalance balance() const;

  /// W/m² per channel of each element, what came so far.
  std::vector<glm::dvec3> irradiance() const;
  /// An estimate of the irradiance still to come, the same everywhere: what is unshot, spread over
  /// all area and reflected in a room of the mean reflectance. [Cohen et al. 1988, equations 5 to
  /// 8]
  glm::dvec3 ambient() const;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace lantern
