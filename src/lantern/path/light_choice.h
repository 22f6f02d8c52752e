// SPDX-License-Identifier: MIT
// Next-event estimation: a point on the emitters, chosen by what each could send to the point to be
// lit; and how likely that choice was for a ray that hit an emitter by itself.
// [Shirley, Wang & Zimmerman 1996, Monte Carlo Techniques for Direct Lighting Calculations]
#pragma once

#include "lantern/path/light_tree.h"
#include "lantern/sampling/distribution.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lantern {

/// Light that arrives at a point from one place. The shadow ray goes from the point along
/// `to_light` up to `far` of its lengths.
struct LightSample {
  Vec3 to_light{0.0f};  // not of unit length
  float far = 1.0f;
  Vec3 direction{0.0f};  // unit length
  // Radiance over the density of this choice in solid angle; from light without area the irradiance
  // of a surface that faces it, over the probability.
  Rgb radiance{0.0f};
  float pdf_solid_angle = 0.0f;  // 0: no ray finds it by chance
};

/// A point to be lit: off its surface, and the normal that its cosine is taken from.
struct LitPoint {
  Vec3 position{0.0f};
  Vec3 normal{0.0f, 1.0f, 0.0f};
};

class LightChoice {
 public:
  /// Keeps references to `scene` and `world`.
  LightChoice(const Scene& scene, const World& world);

  /// Whether anything emits at all.
  bool has_light() const { return has_light_; }

  /// Light from the emitter that u in [0, 1)² chooses; black where it shines elsewhere or nothing
  /// can be chosen. A sky of constant radiance is never chosen: cosine-distributed rays find it
  /// best.
  LightSample sample(const LitPoint& point, Vec2 u) const;

  /// The density in solid angle that sample() would have chosen the triangle's point with, from
  /// `point`, `distance` away along the unit `direction` of a ray that hit it. 0: never.
  float pdf_of_hit(const LitPoint& point, std::uint32_t triangle, const Vec3& direction,
                   float distance) const;

  /// The density of sample() from `point` in solid angle along the unit `direction` of a ray that
  /// leaves the scene.
  float pdf_of_sky(const LitPoint& point, const Vec3& direction) const;

 private:
  enum class Kind : std::uint8_t { kFront, kBack, kPunctual, kSky };
  struct Source {
    Kind kind;
    std::uint32_t index;  // triangle or punctual light
  };

  void add_triangle(std::uint32_t triangle, bool front, std::vector<LightBound>& bounds);
  void add_punctual(std::uint32_t light, std::vector<LightBound>& bounds);
  void add_sky();
  float distant_irradiance(std::size_t i, const LitPoint& point) const;
  float all_distant_irradiance(const LitPoint& point) const;
  LightSample sample_from(const Source& source, float probability, const LitPoint& point,
                          Vec2 u) const;
  LightSample sample_triangle(const Source& source, float probability, const Vec3& point,
                              Vec2 u) const;
  LightSample sample_punctual(const PunctualLight& light, float probability,
                              const Vec3& point) const;
  LightSample sample_sky(float probability, Vec2 u) const;

  const Scene& scene_;
  const World& world_;
  float scale_;
  bool has_light_ = false;
  std::vector<Source> near_;  // what the tree's leaves stand for
  LightTree tree_;
  std::vector<Source> distant_;  // what shines from infinity: suns, and the sky if it is last
  Distribution2D sky_choice_;
  float sky_irradiance_ = 0.0f;                        // mean over directions; 0: never chosen
  std::vector<std::array<std::uint32_t, 2>> leaf_of_;  // of each triangle's front and back
};

}  // namespace lantern
