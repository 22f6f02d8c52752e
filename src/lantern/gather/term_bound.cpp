// SPDX-License-Identifier: MIT
#include "lantern/gather/term_bound.h"

#include "lantern/scene/surface.h"

#include <algorithm>

namespace lantern {

TermBound::TermBound(const Scene& scene, const World& world, const Emitters& emitters,
                     const VirtualLights& lights, float relative)
    : scene_(scene), world_(world) {
  if (!(relative > 0.0f)) return;
  const float radius = world.bounds.radius();
  reflected_ = relative / (radius * radius);
  // Emitters are chosen by flux, so that N starts lie N π L / Φ to the area where the radiance is
  // L.
  const float flux = mean_component(emitters.flux());
  if (flux > 0.0f) emitted_per_radiance_ = kPi * kPi * static_cast<float>(lights.paths) / flux;
}

float TermBound::emitted(std::uint32_t triangle) const {
  const Material& material = scene_.materials[index(world_.materials[triangle])];
  // The ray that looks for a light's triangle may pass through this one.
  if (has_holes(material)) return reflected_;
  return std::max(reflected_, emitted_per_radiance_ * mean_component(material.emission));
}

std::vector<float> TermBound::of_lights(const VirtualLights& lights, const Tracer& tracer) const {
  std::vector<float> bounds(lights.size(), reflected_);
  if (none()) return bounds;
  const float scale = world_.coordinate_scale();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights.bounce[i] != 0 || lights.kind[i] != LightKind::kSurface) continue;
    // Lights do not say which triangle they stand on: it is right below them.
    Ray down;
    down.origin = off_surface(lights.position[i], lights.normal[i], scale);
    down.direction = -lights.normal[i];
    down.far = 2.0f * glm::length(down.origin - lights.position[i]);
    if (const Hit hit = tracer.closest(down)) bounds[i] = emitted(hit.triangle);
  }
  return bounds;
}

}  // namespace lantern
