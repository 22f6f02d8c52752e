// SPDX-License-Identifier: MIT
// The two-room scene: the lamp's room and a dark one behind a wall with a door. With the door shut
// nothing of the light may come through, not in a single bit.
#include "lantern/core/parallel.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace lantern {
namespace {

Scene two_rooms() {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/two_rooms.scene").scene;
}

/// The slab ends inside the wall (x 4 to 4.1, the opening z 1.55 to 2.45 and up to y 2.1), so that
/// it closes the door however its edges round.
void shut_door(Scene& scene) {
  Mesh slab;
  const Vec3 low(4.03f, -0.05f, 1.5f), high(4.07f, 2.15f, 2.5f);
  for (int corner = 0; corner < 8; ++corner) {
    slab.positions.emplace_back((corner & 1) != 0 ? high.x : low.x,
                                (corner & 2) != 0 ? high.y : low.y,
                                (corner & 4) != 0 ? high.z : low.z);
  }
  slab.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  slab.material = to_id<MaterialId>(scene.materials.size());
  scene.materials.emplace_back().reflectance = Rgb(0.8f);
  scene.instances.emplace_back().mesh = to_id<MeshId>(scene.meshes.size());
  scene.meshes.push_back(std::move(slab));
}

RenderOptions options() {
  RenderOptions options;
  options.width = 96;
  options.height = 72;
  options.passes = 6;
  options.lights.paths = 128;
  return options;
}

Image picture(const Scene& scene, const RenderOptions& options) {
  const StopFlag never{false};
  return render(scene, options, never).image;
}

std::size_t lit_pixels(const Image& image) {
  return static_cast<std::size_t>(std::count_if(image.pixels.begin(), image.pixels.end(),
                                                [](const Rgb& p) { return !is_black(p); }));
}

TEST(TwoRooms, LightComesThroughTheOpenDoor) {
  const Image image = picture(two_rooms(), options());
  // Every surface of the room is lit by what the lamp's room reflects, if not by each light.
  EXPECT_GT(lit_pixels(image), image.pixels.size() * 9 / 10);
}

TEST(TwoRooms, NoneComesThroughTheWallsOrTheShutDoor) {
  Scene scene = two_rooms();
  shut_door(scene);
  for (const std::size_t pool : {1, 16}) {
    for (const bool compensate : {false, true}) {
      for (const ShadowRays rays : {ShadowRays::kPackets, ShadowRays::kSingle}) {
        RenderOptions with = options();
        with.lights.pool = pool;
        with.compensate = compensate;
        with.bound = compensate ? 5.0f : 0.0f;
        with.shadow_rays = rays;
        EXPECT_EQ(lit_pixels(picture(scene, with)), 0u) << pool << " " << compensate;
      }
    }
  }
}

TEST(TwoRooms, NoneComesOutside) {
  Scene scene = two_rooms();
  for (const Vec3& eye : {Vec3(14, 5, 8), Vec3(-6, 5, -4), Vec3(4, -8, 2.1f)}) {
    RenderOptions with = options();
    with.compensate = true;
    with.bound = 5.0f;
    with.camera.eye = eye;
    with.camera.target = Vec3(4, 1.5f, 2);
    EXPECT_EQ(lit_pixels(picture(scene, with)), 0u);
  }
}

TEST(TwoRooms, TheLampsRoomStaysLit) {
  Scene scene = two_rooms();
  shut_door(scene);
  RenderOptions with = options();
  with.camera.eye = Vec3(0.3f, 1.6f, 0.4f);
  with.camera.target = Vec3(4, 1.2f, 2);
  const Image image = picture(scene, with);
  EXPECT_EQ(lit_pixels(image), image.pixels.size());
}

}  // namespace
}  // namespace lantern
