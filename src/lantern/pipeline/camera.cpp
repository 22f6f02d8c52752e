// SPDX-License-Identifier: MIT
#include "lantern/pipeline/camera.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <array>

namespace lantern {
namespace {

constexpr float kUsualFov = 0.7f;  // 40 degrees

Camera looking_at(const Vec3& eye, const Vec3& target, float vertical_fov) {
  Camera camera;
  camera.eye = eye;
  camera.forward = glm::normalize(target - eye);
  camera.up = std::abs(camera.forward.y) > 0.99f ? Vec3(0.0f, 0.0f, -1.0f) : Vec3(0.0f, 1.0f, 0.0f);
  camera.vertical_fov = vertical_fov;
  return camera;
}

/// How much of the picture shows the front of a surface, in [0, 1].
float share_of_fronts(const World& world, const Tracer& tracer, const Camera& camera,
                      float aspect) {
  constexpr int kGrid = 24;
  const Vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const Vec3 up = glm::cross(right, camera.forward);
  const float half_height = std::tan(0.5f * camera.vertical_fov);
  int fronts = 0;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const float sx =
          (2.0f * (static_cast<float>(x) + 0.5f) / kGrid - 1.0f) * half_height * aspect;
      const float sy = (2.0f * (static_cast<float>(y) + 0.5f) / kGrid - 1.0f) * half_height;
      Ray ray;
      ray.origin = camera.eye;
      ray.direction = camera.forward + right * sx + up * sy;
      const Hit hit = tracer.closest(ray);
      if (hit && glm::dot(world.area_vector(hit.triangle), ray.direction) < 0.0f) ++fronts;
    }
  }
  return static_cast<float>(fronts) / (kGrid * kGrid);
}

}  // namespace

Camera framing_camera(const World& world, const Tracer& tracer, float vertical_fov, float aspect) {
  if (world.bounds.empty()) return looking_at(Vec3(0.0f, 0.0f, 1.0f), Vec3(0.0f), vertical_fov);
  const Vec3 centre = world.bounds.centre();
  const Vec3 half = 0.5f * (world.bounds.high - world.bounds.low);
  const float half_height = std::tan(0.5f * vertical_fov);

  Camera best;
  float best_share = -1.0f;
  const auto consider = [&](const Camera& camera, float worth) {
    const float share = worth * share_of_fronts(world, tracer, camera, aspect);
    if (share > best_share) {
      best_share = share;
      best = camera;
    }
  };
  // Outside: the near face of the bounds just fits. A little from above where there is something
  // open to look into.
  const std::array<Vec3, 8> directions = {Vec3(0.0f, 0.0f, 1.0f),  Vec3(0.0f, 0.0f, -1.0f),
                                          Vec3(1.0f, 0.0f, 0.0f),  Vec3(-1.0f, 0.0f, 0.0f),
                                          Vec3(0.6f, 0.4f, 0.7f),  Vec3(-0.6f, 0.4f, 0.7f),
                                          Vec3(0.6f, 0.4f, -0.7f), Vec3(-0.6f, 0.4f, -0.7f)};
  for (const Vec3& from : directions) {
    const Vec3 d = glm::normalize(from);
    const Camera at_origin = looking_at(d, Vec3(0.0f), vertical_fov);
    const Vec3 right = glm::normalize(glm::cross(at_origin.forward, at_origin.up));
    const Vec3 up = glm::cross(right, at_origin.forward);
    const float width = glm::dot(glm::abs(right), half), height = glm::dot(glm::abs(up), half);
    const float depth = glm::dot(glm::abs(d), half);
    constexpr float kMargin = 1.05f;
    const float distance =
        depth + kMargin * std::max(height / half_height, width / (half_height * aspect));
    consider(looking_at(centre + d * distance, centre, vertical_fov), 1.0f);
  }
  // Inside: from near one wall at eye's height to the middle of the opposite one. Worth less, so
  // that an object is looked at and only a closed room looked out from.
  for (const Vec3& along : {Vec3(1.0f, 0.0f, 0.0f), Vec3(-1.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 1.0f),
                            Vec3(0.0f, 0.0f, -1.0f)}) {
    constexpr float kNearWall = 0.9f, kInsideWorth = 0.6f;
    const float depth = glm::dot(glm::abs(along), half);
    if (!(depth > 0.0f)) continue;
    const Vec3 eye = centre - along * (kNearWall * depth) - Vec3(0.0f, 0.2f * half.y, 0.0f);
    consider(looking_at(eye, eye + along, vertical_fov),
             kInsideWorth * depth / std::max(half.x, half.z));
  }
  return best;
}

Camera choose_camera(const Scene& scene, const World& world, const Tracer& tracer,
                     const CameraChoice& choice, float aspect) {
  Camera camera;
  if (choice.eye) {
    camera.eye = *choice.eye - scene.origin;
    const Vec3 forward = choice.target - *choice.eye;
    camera.forward = glm::normalize(forward);
    camera.up = choice.up;
    camera.vertical_fov = kUsualFov;
  } else if (!choice.name.empty()) {
    const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const Camera& c) { return c.name == choice.name; });
    if (found == scene.cameras.end()) {
      std::string names;
      for (const Camera& c : scene.cameras) names += (names.empty() ? "" : ", ") + c.name;
      throw Error(fmt::format("--camera: no camera is named '{}'; {}", choice.name,
                              names.empty() ? "the scene has none" : "there are " + names));
    }
    camera = *found;
  } else if (!scene.cameras.empty()) {
    camera = scene.cameras.front();
  } else {
    return framing_camera(world, tracer, choice.vertical_fov.value_or(kUsualFov), aspect);
  }
  if (choice.vertical_fov) camera.vertical_fov = *choice.vertical_fov;
  return camera;
}

}  // namespace lantern
