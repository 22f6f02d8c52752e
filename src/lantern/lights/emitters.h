// SPDX-License-Identifier: MIT
// Everything in a scene that sends out light, chosen in proportion to its flux: emitting triangles
// (each side), punctual lights, the sky.
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/sampling/distribution.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

/// Where a path starts: the light that stands there and the ray that leaves it.
struct PathStart {
  LightKind kind = LightKind::kSurface;
  Vec3 position{0.0f};
  Vec3 normal{0.0f};
  Vec2 cone{0.0f};
  Rgb light_flux{0.0f};  // of the light, over the probability of this start
  Rgb ray_flux{0.0f};    // carried by the ray, likewise
  Vec3 origin{0.0f};
  Vec3 direction{0.0f};
};

class Emitters {
 public:
  /// Keeps references to `scene` and `world`.
  Emitters(const Scene& scene, const World& world);

  bool empty() const { return sources_.empty(); }
  /// All flux that enters the scene, in W; what comes from infinity counts over the disc of the
  /// scene's bounding sphere.
  Rgb flux() const { return flux_; }

  /// `place` chooses the emitter and the point on it (the sky: the direction), `way` the direction
  /// that the ray leaves in (from infinity: the point of the bounding disc). Both in [0, 1)². Must
  /// not be empty().
  PathStart start(Vec2 place, Vec2 way) const;

 private:
  enum class Kind : std::uint8_t { kFront, kBack, kPunctual, kSky };
  struct Source {
    Kind kind;
    std::uint32_t index;  // triangle or punctual light
  };

  void add(Source source, const Rgb& flux);
  PathStart start_on_triangle(const Source& source, float probability, Vec2 place, Vec2 way) const;
  PathStart start_at_punctual(const PunctualLight& light, float probability, Vec2 way) const;
  PathStart start_at_sky(float probability, Vec2 place, Vec2 way) const;
  PathStart start_from_infinity(const Vec3& direction, const Rgb& irradiance, Vec2 way) const;

  const Scene& scene_;
  const World& world_;
  std::vector<Source> sources_;
  std::vector<double> weights_;
  Distribution choice_;
  Distribution2D sky_choice_;
  Vec3 centre_{0.0f};
  float radius_ = 0.0f;
  Rgb flux_{0.0f};
};

/// Emitted flux in W of one side of a triangle: π times the integral of its radiance.
Rgb triangle_flux(const Scene& scene, const World& world, std::uint32_t triangle, bool front);

}  // namespace lantern
