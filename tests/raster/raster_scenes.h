// SPDX-License-Identifier: MIT
// Scenes with their lights, ready for both ways of gathering.
#pragma once

#include "lantern/core/hash.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/lights/walk.h"
#include "lantern/load/load.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/surface.h"

#include "tests/analytic/rooms.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace lantern::test {

/// A scene made ready and its lights.
struct RasterStage : Stage {
  using Stage::Stage;

  VirtualLights lights(std::size_t paths) const {
    WalkOptions options;
    options.paths = paths;
    options.reflectivity = mean_reflectivity(scene, world);
    return walk(scene, world, *tracer, emitters, options);
  }
};

/// Eyes anywhere in the scene's box.
inline std::vector<Camera> random_cameras(const Bounds& box, int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const auto number = [&](std::uint64_t n) {
      return to_unit_float(hash(static_cast<std::uint64_t>(i), n));
    };
    Camera camera;
    camera.eye = glm::mix(box.low, box.high, Vec3(number(0), number(1), number(2)));
    const Vec3 target = glm::mix(box.low, box.high, Vec3(number(3), number(4), number(5)));
    camera.forward = glm::normalize(target - camera.eye);
    camera.vertical_fov = 0.4f + 1.5f * number(6);
    cameras.push_back(camera);
  }
  return cameras;
}

inline Scene own_scene(const std::string& name) {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name).scene;
}

/// A ball of 2 * slices * (stacks - 1) triangles whose fronts look out.
inline Mesh ball(std::uint32_t slices, std::uint32_t stacks, MaterialId material) {
  Mesh mesh;
  mesh.material = material;
  const auto ring = [&](std::uint32_t stack, std::uint32_t slice) {
    return 1 + (stack - 1) * slices + slice % slices;
  };
  mesh.positions.emplace_back(0.0f, 1.0f, 0.0f);
  for (std::uint32_t stack = 1; stack < stacks; ++stack) {
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
      const float polar = kPi * static_cast<float>(stack) / static_cast<float>(stacks);
      const float azimuth = 2.0f * kPi * static_cast<float>(slice) / static_cast<float>(slices);
      mesh.positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                  std::sin(polar) * std::sin(azimuth));
    }
  }
  const auto bottom = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0.0f, -1.0f, 0.0f);
  for (std::uint32_t slice = 0; slice < slices; ++slice) {
    mesh.triangles.emplace_back(0u, ring(1, slice + 1), ring(1, slice));
    mesh.triangles.emplace_back(bottom, ring(stacks - 1, slice), ring(stacks - 1, slice + 1));
    for (std::uint32_t stack = 1; stack + 1 < stacks; ++stack) {
      const std::uint32_t a = ring(stack, slice), b = ring(stack, slice + 1);
      const std::uint32_t c = ring(stack + 1, slice + 1), d = ring(stack + 1, slice);
      mesh.triangles.emplace_back(a, b, c);
      mesh.triangles.emplace_back(a, c, d);
    }
  }
  mesh.normals = mesh.positions;  // of a unit ball
  return mesh;
}

/// A room with 64 balls in it, lit by a lamp below its ceiling.
inline Scene room_of_balls(std::uint32_t slices, std::uint32_t stacks) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[0].reflectance = Rgb(0.6f, 0.55f, 0.5f);
  scene.materials[1].reflectance = Rgb(0.3f, 0.5f, 0.7f);
  scene.materials[2].emission = Rgb(16.0f, 15.0f, 14.0f);
  Mesh room;
  for (int corner = 0; corner < 8; ++corner) {
    room.positions.emplace_back((corner & 1) != 0 ? 4 : 0, (corner & 2) != 0 ? 4 : 0,
                                (corner & 4) != 0 ? 4 : 0);
  }
  room.triangles = {{0, 3, 2}, {0, 1, 3}, {4, 7, 5}, {4, 6, 7}, {0, 6, 4}, {0, 2, 6},
                    {1, 7, 3}, {1, 5, 7}, {0, 5, 1}, {0, 4, 5}, {2, 3, 7}, {2, 7, 6}};
  Mesh lamp;
  lamp.positions = {{1.0f, 3.9f, 1.0f}, {3.0f, 3.9f, 1.0f}, {3.0f, 3.9f, 3.0f}, {1.0f, 3.9f, 3.0f}};
  lamp.triangles = {{0, 1, 2}, {0, 2, 3}};
  lamp.material = to_id<MaterialId>(2);
  scene.meshes = {room, lamp, ball(slices, stacks, to_id<MaterialId>(1))};
  scene.instances.resize(2);
  scene.instances[1].mesh = to_id<MeshId>(1);
  for (int i = 0; i < 64; ++i) {
    const Vec3 place(static_cast<float>(i % 4), static_cast<float>(i / 4 % 4),
                     static_cast<float>(i / 16));
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = to_id<MeshId>(2);
    instance.transform = glm::scale(glm::translate(Mat4(1.0f), place + 0.5f), Vec3(0.27f));
  }
  Camera camera;
  camera.eye = Vec3(0.05f, 1.9f, 3.98f);
  camera.forward = glm::normalize(Vec3(0.55f, -0.1f, -0.8f));
  camera.vertical_fov = 1.2f;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace lantern::test
