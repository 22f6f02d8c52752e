// SPDX-License-Identifier: MIT
// A pinhole camera and the size of a picture -> the rays that see it.
#pragma once

#include "lantern/scene/scene.h"

#include <cmath>

namespace lantern {

/// Rays from the eye through points of the picture, in pixels from its upper left corner.
/// Directions are not unit length.
class Eye {
 public:
  Eye(const Camera& camera, int width, int height) : origin_(camera.eye) {
    const Vec3 forward = glm::normalize(camera.forward);
    const Vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const Vec3 up = glm::cross(right, forward);
    const float half_height = std::tan(0.5f * camera.vertical_fov);
    const float pixel = 2.0f * half_height / static_cast<float>(height);
    step_x_ = right * pixel;
    step_y_ = -up * pixel;
    corner_ = forward - step_x_ * (0.5f * static_cast<float>(width)) -
              step_y_ * (0.5f * static_cast<float>(height));
  }

  Vec3 origin() const { return origin_; }
  Vec3 direction(float x, float y) const { return corner_ + step_x_ * x + step_y_ * y; }

 private:
  Vec3 origin_, corner_, step_x_, step_y_;
};

}  // namespace lantern
