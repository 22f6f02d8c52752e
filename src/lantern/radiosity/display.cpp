// SPDX-License-Identifier: MIT
#include "lantern/radiosity/display.h"

#include "lantern/radiosity/interpolation.h"
#include "lantern/scene/sky.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/eye.h"

#include <algorithm>
#include <cassert>

namespace lantern {
namespace {

/// Where in its pixel sample `n` lies: the centre first, then ever finer in between. Powers of the
/// plastic number. [Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences]
Vec2 place_in_pixel(int n) {
  constexpr double kPlastic = 1.32471795724474602596;
  const glm::dvec2 step(1.0 / kPlastic, 1.0 / (kPlastic * kPlastic));
  return Vec2(glm::fract(0.5 + static_cast<double>(n) * step));
}

}  // namespace

Display::Display(const Scene& scene, const World& world, const Patches& patches)
    : scene_(scene),
      patches_(patches),
      world_(patch_world(world, patches)),
      tracer_(make_embree_tracer(scene, world_)) {}

Image Display::draw(const Camera& camera, std::span<const glm::dvec3> irradiance,
                    const DisplayOptions& options, const StopFlag& stop,
                    const std::function<void(std::size_t)>& rows_done) const {
  assert(irradiance.size() == patches_.elements());
  const VertexValues values = interpolate_to_vertices(patches_, irradiance);
  const Eye eye(camera, options.width, options.height);
  const auto radiance = [&](const Hit& hit, const Vec3& direction) {
    if (!hit) return sky_radiance(scene_, direction);
    const bool front = glm::dot(world_.area_vector(hit.triangle), direction) < 0.0f;
    const std::vector<glm::dvec3>& at = front ? values.front : values.back;
    const uvec3 v = patches_.smooth_vertices[hit.triangle];
    const glm::dvec2 w(hit.uv);
    const Rgb arriving(at[v.x] * (1.0 - w.x - w.y) + at[v.y] * w.x + at[v.z] * w.y);
    return emission_at(scene_, world_, hit.triangle, hit.uv, front) +
           surface_at(scene_, world_, hit.triangle, hit.uv).reflectance * arriving * kInvPi;
  };

  Image image(options.width, options.height);
  const float share = 1.0f / static_cast<float>(options.samples);
  parallel_for(static_cast<std::size_t>(options.height), 1, [&](std::size_t row) {
    if (stop.load(std::memory_order_relaxed)) return;
    const int y = static_cast<int>(row);
    for (int x0 = 0; x0 < options.width; x0 += kPacket) {
      const int count = std::min(kPacket, options.width - x0);
      for (int sample = 0; sample < options.samples; ++sample) {
        const Vec2 place = place_in_pixel(sample);
        RayPacket rays{};
        LaneMask active{};
        Vec3 directions[kPacket];
        for (int i = 0; i < count; ++i) {
          directions[i] =
              eye.direction(static_cast<float>(x0 + i) + place.x, static_cast<float>(y) + place.y);
          rays.set(i, eye.origin(), directions[i]);
          active.lane[i] = -1;
        }
        Hit hits[kPacket];
        tracer_->closest(active, rays, hits);
        for (int i = 0; i < count; ++i) {
          image.at(x0 + i, y) += share * radiance(hits[i], directions[i]);
        }
      }
    }
    if (rows_done) rows_done(static_cast<std::size_t>(options.width));
  });
  return image;
}

}  // namespace lantern
