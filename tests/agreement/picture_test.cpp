// SPDX-License-Identifier: MIT
// Whole pictures: the same bits however they are made, no light through walls, and the Cornell box
// against a reference that an independent path tracer made.
#include "lantern/image/compare.h"
#include "lantern/image/read.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/render.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace lantern::test {
namespace {

Scene own_scene(const char* name) {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name).scene;
}

Image picture(const Scene& scene, const RenderOptions& options, int threads = 0) {
  const StopFlag never{false};
  Image image;
  ThreadScope scope(threads);
  scope.run([&] { image = render(scene, options, never).image; });
  return image;
}

/// A plane under a sky and a sun, with a chequered fence full of holes and a pane of glass on it.
Scene outdoors() {
  Scene scene;
  Texture chequer;
  chequer.width = chequer.height = 2;
  chequer.srgb8 = {255, 255, 255, 255, 40, 90, 200, 0, 40, 90, 200, 0, 255, 200, 90, 255};
  scene.textures.push_back(chequer);
  Material ground, fence, glass;
  ground.name = "ground";
  ground.reflectance = Rgb(0.6f, 0.5f, 0.4f);
  fence.name = "fence";
  fence.reflectance = Rgb(0.8f);
  fence.reflectance_texture = TextureId{0};
  fence.alpha_cutoff = 0.5f;
  glass.name = "glass";
  glass.opacity = 0.4f;
  glass.blend = true;
  scene.materials = {ground, fence, glass};
  const auto add_quad = [&](MaterialId material, Vec3 corner, Vec3 a, Vec3 b) {
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.texcoords = {{0.0f, 4.0f}, {4.0f, 4.0f}, {4.0f, 0.0f}, {0.0f, 0.0f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({to_id<MeshId>(scene.meshes.size()), Mat4(1.0f), {}});
    scene.meshes.push_back(std::move(mesh));
  };
  add_quad(MaterialId{0}, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  add_quad(MaterialId{1}, {-2, 0, 0}, {3, 0, 0}, {0, 2, 0});
  add_quad(MaterialId{2}, {1.5f, 0, 1}, {1, 0, -2}, {0, 2, 0});
  PunctualLight sun;
  sun.kind = PunctualKind::kDirectional;
  sun.intensity = Rgb(3.0f, 2.8f, 2.5f);
  sun.direction = glm::normalize(Vec3(0.4f, -1.0f, -0.3f));
  scene.lights.push_back(sun);
  scene.sky = Sky{Rgb(0.5f, 0.6f, 0.8f), {}};
  Camera camera;
  camera.eye = {1, 2, 6};
  camera.forward = glm::normalize(Vec3(-0.15f, -0.25f, -1));
  scene.cameras.push_back(camera);
  return scene;
}

RenderOptions small_options() {
  RenderOptions options;
  options.width = 70;  // neither a multiple of the tile nor of the packet
  options.height = 54;
  options.lights.paths = 24;
  options.lights.pool = 4;
  options.passes = 2;
  options.samples = 2;
  options.bound = 5.0f;
  options.compensate = true;
  return options;
}

class SameBits : public testing::TestWithParam<const char*> {
 protected:
  const Scene scene_ = std::string(GetParam()) == "outdoors" ? outdoors() : own_scene(GetParam());
};

TEST_P(SameBits, OnAnyNumberOfThreads) {
  const Image one = picture(scene_, small_options(), 1);
  EXPECT_EQ(one.pixels, picture(scene_, small_options(), 2).pixels);
  EXPECT_EQ(one.pixels, picture(scene_, small_options(), 7).pixels);
}

TEST_P(SameBits, WithPacketsAndSingleRays) {
  // Embree rounds differently in its coherent packets and for single rays: of ten million shadow
  // rays in each of four scenes two met another triangle, both within 1e-6 of its edge. None of
  // these do.
  RenderOptions single = small_options();
  single.shadow_rays = ShadowRays::kSingle;
  EXPECT_EQ(picture(scene_, small_options()).pixels, picture(scene_, single).pixels);
}

TEST_P(SameBits, ButOtherBitsWithAnotherSeed) {
  RenderOptions other = small_options();
  other.lights.points.seed = 1;
  EXPECT_NE(picture(scene_, small_options()).pixels, picture(scene_, other).pixels);
}

INSTANTIATE_TEST_SUITE_P(Pictures, SameBits,
                         testing::Values("cornell_box.scene", "many_emitters.scene", "outdoors"));

double brightest(const Image& image) {
  float most = 0.0f;
  for (const Rgb& pixel : image.pixels) most = std::max(most, max_component(pixel));
  return static_cast<double>(most);
}

/// The room behind the door, whole: from one corner to the opposite one.
RenderOptions dark_room_options() {
  RenderOptions options = small_options();
  options.camera.eye = Vec3(4.2f, 0.1f, 0.1f);
  options.camera.target = Vec3(8.0f, 2.0f, 4.0f);
  options.camera.vertical_fov = 1.8f;
  options.passes = 16;
  return options;
}

TEST(TwoRooms, LeakNoLightWithTheDoorShut) {
  Scene scene = own_scene("two_rooms.scene");
  Mesh slab;  // fills the opening of 0.9 x 2.1 m and reaches a little into wall and floor
  slab.name = "door";
  const Vec3 low(4.02f, -0.05f, 1.5f), high(4.08f, 2.15f, 2.5f);
  for (int i = 0; i < 8; ++i) {
    slab.positions.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  slab.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  scene.instances.push_back({to_id<MeshId>(scene.meshes.size()), Mat4(1.0f), {}});
  scene.meshes.push_back(slab);
  EXPECT_EQ(brightest(picture(scene, dark_room_options())), 0.0);
  RenderOptions plain = dark_room_options();
  plain.compensate = false;
  plain.lights.pool = 1;
  plain.bound = 0.0f;
  EXPECT_EQ(brightest(picture(scene, plain)), 0.0);
}

TEST(TwoRooms, AreLitThroughTheOpenDoor) {
  EXPECT_GT(brightest(picture(own_scene("two_rooms.scene"), dark_room_options())), 0.0);
}

TEST(CornellBox, ApproachesTheReference) {
  const auto folder = shared_folder("reference");
  if (!folder) GTEST_SKIP() << "the reference picture is not at hand";
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "too long under sanitizers; the other pictures run the same code";
#endif
  const Image reference = read_image(*folder / "cornell_box.exr");
  const Scene scene = own_scene("cornell_box.scene");
  RenderOptions options;
  options.width = reference.width;
  options.height = reference.height;
  options.lights.paths = 32;
  options.lights.pool = 16;
  options.bound = 5.0f;
  options.compensate = true;
  options.passes = 8;
  const Comparison early = compare(picture(scene, options), reference);
  options.passes = 128;
  const Comparison late = compare(picture(scene, options), reference);
  // Sixteen times the passes: independent ones would leave a sixteenth of the error.
  EXPECT_LT(late.relmse, early.relmse / 8.0);
  EXPECT_LT(late.relmse, 3e-4);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(late.mean_a[c] / late.mean_b[c], 1.0, 3e-3) << c;
}

TEST(OgreContent, RendersWithoutAWarningAboutItsFormat) {
  const auto folder = shared_folder("scenes/ogre");
  if (!folder) GTEST_SKIP() << "Ogre's sample scenes are not at hand";
  for (const char* name : {"cornell.mesh", "sibenik.mesh"}) {
    Loaded loaded = load_scene(*folder / name);
    for (const std::string& warning : loaded.report.warnings) {
      EXPECT_NE(warning.find("triangles without area"), std::string::npos) << warning;
    }
    EXPECT_TRUE(loaded.report.unknown.empty()) << name;
    PunctualLight sun;
    sun.kind = PunctualKind::kDirectional;
    sun.direction = glm::normalize(Vec3(0.5f, -1.0f, 0.3f));
    loaded.scene.lights.push_back(sun);
    loaded.scene.sky = Sky{};
    RenderOptions options;
    options.width = options.height = 32;
    options.lights.paths = 64;
    const Image image = picture(loaded.scene, options);
    double sum = 0.0;
    for (const Rgb& pixel : image.pixels) sum += static_cast<double>(mean_component(pixel));
    const double mean = sum / static_cast<double>(image.pixels.size());
    // A sky of radiance 1 and a sun of 1 W/m² can light no Lambertian surface above 1 + 1/π but by
    // what it gets from others; nothing seen at all would be black.
    EXPECT_GT(mean, 0.1) << name;
    EXPECT_LT(mean, 2.0) << name;
  }
}

}  // namespace
}  // namespace lantern::test
