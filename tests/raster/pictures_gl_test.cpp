// SPDX-License-Identifier: MIT
// Whole pictures by GL against those by shadow rays: the same lights, materials and samples.
#include "lantern/core/error.h"
#include "lantern/core/hash.h"
#include "lantern/gl/context.h"
#include "lantern/image/compare.h"
#include "lantern/pipeline/render.h"
#include "lantern/raster/rasteriser.h"

#include "tests/raster/raster_scenes.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <optional>
#include <utility>

namespace lantern {
namespace {

using ::testing::HasSubstr;

RenderOptions small(std::size_t paths) {
  RenderOptions options;
  options.width = 96;
  options.height = 96;
  options.lights.paths = paths;
  options.bound = 20.0f;
  return options;
}

Image picture(const Scene& scene, RenderOptions options, Backend backend) {
  options.backend = backend;
  const StopFlag never{false};
  return render(scene, options, never).image;
}

/// Mean of |a - b| over that of b.
double mean_difference(const Image& a, const Image& b) {
  double difference = 0.0, all = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 p(a.pixels[i]), q(b.pixels[i]);
    difference += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b);
    all += q.r + q.g + q.b;
  }
  return difference / all;
}

/// Share of the pixels that differ by more than rounding.
double differing(const Image& a, const Image& b) {
  constexpr float kRounding = 1e-3f;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgb off = glm::abs(a.pixels[i] - b.pixels[i]);
    count += max_component(off) > kRounding * max_component(b.pixels[i]) ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

/// Mean of blocks of eight by eight pixels, in which each ray's chance averages out.
Image coarse(const Image& image) {
  constexpr int kBlock = 8;
  Image result(image.width / kBlock, image.height / kBlock);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto from = static_cast<std::size_t>(y * image.width + x);
      const auto to = static_cast<std::size_t>(y / kBlock * result.width + x / kBlock);
      result.pixels[to] += image.pixels[from] * (1.0f / (kBlock * kBlock));
    }
  }
  return result;
}

/// Corners on a grid of 1/256 of a pixel and normals of 16 bits a coordinate.
constexpr double kRasterRounding = 0.001;

void expect_same(const Scene& scene, const RenderOptions& options) {
  const Image cpu = picture(scene, options, Backend::kCpu);
  const Image gl = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(gl, cpu), kRasterRounding);
  // A pixel on an edge of a surface sees the other one.
  EXPECT_LT(differing(gl, cpu), 0.01);
  EXPECT_GT(max_component(Rgb(compare(cpu, gl).mean_b)), 0.0f);
}

TEST(Pictures, CornellBox) {
  RenderOptions options = small(64);
  options.samples = 2;
  expect_same(test::own_scene("cornell_box.scene"), options);
}

TEST(Pictures, PassesAreTheSameToo) {
  RenderOptions options = small(16);
  options.passes = 3;
  options.lights.pool = 4;
  expect_same(test::own_scene("cornell_box.scene"), options);
}

TEST(Pictures, TwoRooms) { expect_same(test::own_scene("two_rooms.scene"), small(64)); }

TEST(Pictures, ManyEmitters) { expect_same(test::own_scene("many_emitters.scene"), small(64)); }

TEST(Pictures, Balls) { expect_same(test::room_of_balls(12, 12), small(24)); }

/// Their backs are outside; and neither side of the picture is one of whole quads.
TEST(Pictures, BallsTurnedInsideOut) {
  Scene scene = test::room_of_balls(12, 12);
  for (uvec3& triangle : scene.meshes[2].triangles) std::swap(triangle.y, triangle.z);
  RenderOptions options = small(24);
  options.width = 93;
  options.height = 95;
  expect_same(scene, options);
}

TEST(Pictures, SibenikUnderSunAndSky) {
  const auto folder = test::shared_folder("scenes/ogre");
  if (!folder) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  Scene scene = load_scene(*folder / "sibenik.mesh").scene;
  scene.sky = Sky{};
  PunctualLight sun;
  sun.kind = PunctualKind::kDirectional;
  sun.intensity = Rgb(20.0f);
  sun.direction = glm::normalize(Vec3(0.3f, -1.0f, 0.2f));
  scene.lights.push_back(sun);
  // Its windows are veils, in which every ray has its own chance.
  const RenderOptions options = small(24);
  const Image cpu = coarse(picture(scene, options, Backend::kCpu));
  EXPECT_LT(mean_difference(coarse(picture(scene, options, Backend::kGl)), cpu), 0.02);
  for (Material& material : scene.materials) material.blend = false;
  expect_same(scene, options);
}

Texture noise_texture(int width, int height, bool bytes) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  const auto channels = static_cast<std::size_t>(4 * width * height);
  for (std::size_t i = 0; i < channels; ++i) {
    const auto value = static_cast<std::uint8_t>(hash(i));
    if (bytes) {
      texture.srgb8.push_back(i % 4 == 3 ? std::uint8_t{255} : value);
    } else {
      texture.linear.push_back(i % 4 == 3 ? 1.0f : static_cast<float>(value) / 255.0f);
    }
  }
  return texture;
}

/// Everything that materials and lights can have at once.
Scene exhibition() {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(12);
  for (const bool bytes : {true, false}) scene.textures.push_back(noise_texture(7, 5, bytes));
  scene.textures[0].wrap_u = Wrap::kMirror;
  scene.textures[1].wrap_v = Wrap::kClamp;
  scene.textures.push_back(noise_texture(16, 8, false));
  Material& walls = scene.materials[0];
  walls.reflectance_texture = to_id<TextureId>(0);
  walls.vertex_colours = true;
  Mesh& room = scene.meshes[0];
  for (std::size_t i = 0; i < room.positions.size(); ++i) {
    room.texcoords.push_back(Vec2(room.positions[i]) * 0.9f - Vec2(1.3f, room.positions[i].z));
    const float shade = 0.5f + 0.05f * static_cast<float>(i);
    room.colours.emplace_back(shade, 1.0f, 1.5f - shade, 1.0f);
  }
  room.triangles.resize(room.triangles.size() - 2);  // for the sky to shine in
  Material& lamp = scene.materials[2];
  lamp.emission_texture = to_id<TextureId>(1);
  lamp.emission = Rgb(2.0f);  // or a single pixel on its edge shows in the mean
  lamp.double_sided = true;
  scene.meshes[1].texcoords = {{-0.5f, -0.5f}, {2.5f, -0.5f}, {2.5f, 2.5f}, {-0.5f, 2.5f}};
  scene.instances[3].transform = glm::scale(scene.instances[3].transform, Vec3(-1.0f, 1.5f, 1.0f));

  Sky sky;
  sky.radiance = Rgb(0.5f, 0.6f, 0.8f);
  sky.texture = to_id<TextureId>(2);
  scene.sky = sky;
  PunctualLight point, spot, sun;
  point.position = Vec3(3.1f, 2.0f, 3.0f);
  point.intensity = Rgb(2.0f, 1.0f, 0.5f);
  spot.kind = PunctualKind::kSpot;
  spot.position = Vec3(3.5f, 3.5f, 3.5f);
  spot.direction = glm::normalize(Vec3(-0.8f, -1.0f, -0.9f));
  spot.intensity = Rgb(3.0f, 5.0f, 3.0f);
  spot.inner_angle = 0.3f;
  spot.outer_angle = 0.6f;
  sun.kind = PunctualKind::kDirectional;
  sun.direction = glm::normalize(Vec3(0.2f, -1.0f, -0.3f));
  sun.intensity = Rgb(3.0f, 2.9f, 2.5f);
  scene.lights = {point, spot, sun};
  scene.cameras[0].eye = Vec3(0.3f, 0.3f, 3.9f);
  scene.cameras[0].forward = glm::normalize(Vec3(0.5f, 0.45f, -0.8f));
  return scene;
}

TEST(Pictures, TexturesColoursSmoothNormalsAndEveryKindOfLight) {
  expect_same(exhibition(), small(96));
}

TEST(Pictures, ThousandsOfLightsLoseNothing) {
  RenderOptions options = small(1000);
  options.width = options.height = 32;
  const Scene scene = test::own_scene("cornell_box.scene");
  const Image cpu = picture(scene, options, Backend::kCpu);
  const Image gl = picture(scene, options, Backend::kGl);
  // Away from edges; a 16-bit sum would be 3 % off at 256 lights already.
  std::vector<double> off;
  for (std::size_t i = 0; i < cpu.pixels.size(); ++i) {
    if (is_black(cpu.pixels[i])) continue;
    off.push_back(std::abs(luminance(gl.pixels[i]) / luminance(cpu.pixels[i]) - 1.0));
  }
  std::sort(off.begin(), off.end());
  EXPECT_GT(off.size(), cpu.pixels.size() / 2);
  EXPECT_LT(off[off.size() / 2], 1e-5);
  EXPECT_LT(off[off.size() * 9 / 10], 1e-4);
  const Comparison comparison = compare(gl, cpu);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(comparison.mean_a[channel] / comparison.mean_b[channel], 1.0, 1e-4);
  }
}

/// A pixel knows of a light what pixels up to half a tile away see: edges of shadows are off.
TEST(Pictures, InterleavedComesClose) {
  struct Case {
    Scene scene;
    int tile, width, height;
    double mean;
  };
  // 250 and 190 are no multiple of any tile. A ball has twenty pixels there.
  const std::vector<Case> cases = {{test::own_scene("cornell_box.scene"), 2, 250, 190, 0.004},
                                   {test::own_scene("cornell_box.scene"), 4, 250, 190, 0.008},
                                   {test::own_scene("cornell_box.scene"), 8, 250, 190, 0.014},
                                   {test::own_scene("two_rooms.scene"), 4, 250, 190, 0.011},
                                   {test::own_scene("two_rooms.scene"), 8, 250, 190, 0.019},
                                   {test::room_of_balls(12, 12), 4, 250, 190, 0.02},
                                   {test::room_of_balls(12, 12), 4, 640, 480, 0.014}};
  for (const Case& tested : cases) {
    RenderOptions options = small(140);  // about 256 lights
    options.width = tested.width;
    options.height = tested.height;
    const Image all = picture(tested.scene, options, Backend::kGl);
    options.tile = tested.tile;
    const Image shared = picture(tested.scene, options, Backend::kGl);
    EXPECT_LT(mean_difference(shared, all), tested.mean) << tested.tile;
    const Comparison comparison = compare(shared, all);
    EXPECT_NEAR(comparison.mean_a.g / comparison.mean_b.g, 1.0, 0.01);
  }
}

/// What is likely to take less time is as close: where silhouettes are drawn for many samples,
/// maps.
TEST(Pictures, InterleavedByMapsComesClose) {
  const Scene scene = test::room_of_balls(12, 12);
  RenderOptions options = small(140);
  options.width = 250;
  options.height = 190;
  const Image all = picture(scene, options, Backend::kGl);
  options.tile = 4;
  const Image by_volumes = picture(scene, options, Backend::kGl);
  options.shadows = ShadowMethod::kMaps;
  const Image by_maps = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(by_maps, all), 0.02);
  EXPECT_LT(mean_difference(by_maps, by_volumes), 0.005);
  options.shadows = ShadowMethod::kCheaper;
  EXPECT_EQ(picture(scene, options, Backend::kGl).pixels, by_volumes.pixels);
  options.width = options.height = 32;
  options.lights.paths = 16;
  options.samples = 100;
  const Image of_many = picture(scene, options, Backend::kGl);
  options.shadows = ShadowMethod::kMaps;
  EXPECT_EQ(picture(scene, options, Backend::kGl).pixels, of_many.pixels);
}

/// More than one group of 32 for each share, of all formulas, and more than one block of them.
/// Edges of shadows are off: 0.8 %, the mean 0.1 %.
TEST(Pictures, InterleavedTakesManyLightsOfEveryKind) {
  const Scene scene = exhibition();
  RenderOptions options = small(700);
  const Image all = picture(scene, options, Backend::kGl);
  options.tile = 2;
  const Image shared = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(shared, all), 0.01);
  const Comparison comparison = compare(shared, all);
  EXPECT_NEAR(comparison.mean_a.g / comparison.mean_b.g, 1.0, 0.002);
}

/// The nave of sibenik.mesh; none where the shared folder is not there.
std::optional<Scene> nave(RenderOptions& options) {
  const auto folder = test::shared_folder("scenes/ogre");
  if (!folder) return std::nullopt;
  options.camera.eye = Vec3(12.0f, 3.0f, 0.0f);
  options.camera.target = Vec3(-20.0f, 7.0f, 0.0f);
  return load_scene(*folder / "sibenik.mesh").scene;
}

std::optional<Scene> nave_under_the_sky(RenderOptions& options) {
  std::optional<Scene> scene = nave(options);
  if (scene) scene->sky = Sky{};
  return scene;
}

/// Its stained glass shines.
std::optional<Scene> nave_by_its_windows(RenderOptions& options) {
  std::optional<Scene> scene = nave(options);
  if (!scene) return std::nullopt;
  for (Material& material : scene->materials) {
    if (material.name.find("staklo") != std::string::npos) material.emission = Rgb(20.0f);
  }
  return scene;
}

/// Mouldings throw shadows of one or two pixels on what they lie on, which few shares have a pixel
/// in. 1.7 %, by the pixels around alone 2.3.
TEST(Pictures, InterleavedComesCloseInsideSibenikByItsWindows) {
  RenderOptions options = small(143);
  options.width = 640;
  options.height = 480;
  const std::optional<Scene> scene = nave_by_its_windows(options);
  if (!scene) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  const Image exact = picture(*scene, options, Backend::kGl);
  options.tile = 4;
  EXPECT_LT(mean_difference(picture(*scene, options, Backend::kGl), exact), 0.02);
}

/// Below a ledge a line of shadow on a bright wall, one to two pixels wide: half of the shares see
/// none of it.
TEST(Pictures, InterleavedKnowsShadowsThatFewSharesSee) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].reflectance = Rgb(0.5f);
  scene.materials[1].emission = Rgb(10.0f);
  Mesh wall, ledge, lamp;
  wall.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 0.5f, 0}, {-1, 0.5f, 0}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  ledge.positions = {{-1, 0, 0},      {1, 0, 0},         {1, 0, 0.006f},
                     {-1, 0, 0.006f}, {1, 0.1f, 0.006f}, {-1, 0.1f, 0.006f}};
  ledge.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
  lamp.positions = {{-1, 3, 1}, {1, 3, 1}, {1, 3, 3}, {-1, 3, 3}};
  lamp.triangles = {{0, 1, 2}, {0, 2, 3}};
  lamp.material = to_id<MaterialId>(1);
  scene.meshes = {wall, ledge, lamp};
  for (std::uint32_t mesh = 0; mesh < 3; ++mesh) {
    scene.instances.emplace_back().mesh = to_id<MeshId>(mesh);
  }
  RenderOptions options = small(256);
  options.camera.eye = Vec3(0.0f, -0.05f, 1.0f);
  options.camera.target = Vec3(0.0f, -0.05f, 0.0f);
  const Image exact = picture(scene, options, Backend::kGl);
  options.tile = 4;
  const Image shared = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(shared, exact), 0.004);  // 1.1 % by the pixels around alone
  const auto middle_of_row = [](const Image& image, std::size_t y) {
    return image.pixels[y * 96 + 48].g;
  };
  ASSERT_EQ(middle_of_row(exact, 41), 0.0f);
  ASSERT_GT(middle_of_row(exact, 44), 0.19f);
  EXPECT_LT(middle_of_row(shared, 41), 0.01f);  // half as bright as the wall by those
}

/// Not what the shares of a row see by chance: dashes on the wall behind the table.
TEST(Pictures, InterleavedTakesNoChanceForAShadow) {
  RenderOptions options = small(140);
  options.width = 250;
  options.height = 190;
  const Scene scene = test::own_scene("two_rooms.scene");
  const Image exact = picture(scene, options, Backend::kGl);
  options.tile = 4;
  const Image shared = picture(scene, options, Backend::kGl);
  const float dim = 0.05f * static_cast<float>(compare(shared, exact).mean_b.g);
  int dark = 0;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
    const float here = exact.pixels[i].g;
    if (here > dim && shared.pixels[i].g < 0.5f * here) ++dark;
  }
  EXPECT_LT(dark, 25);  // 15 on edges; 53 were lights counted that other surfaces alone see
}

/// Nearly all lights are hidden: were those seen that no pixel around can tell of, edges would
/// shine, 1.8 times the light.
TEST(Pictures, InterleavedLeavesAChurchDarkThatTheSkyLightsThroughItsWindows) {
  RenderOptions options = small(48);
  const std::optional<Scene> scene = nave_under_the_sky(options);
  if (!scene) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  const Image exact = picture(*scene, options, Backend::kGl);
  options.tile = 4;
  const Comparison comparison = compare(picture(*scene, options, Backend::kGl), exact);
  // Few pixels, most of them on edges of shadows: 4 % here.
  EXPECT_NEAR(comparison.mean_a.g / comparison.mean_b.g, 1.0, 0.1);
}

/// What maps miss stands behind something that is more slender than a texel, a fiftieth of a
/// radian.
TEST(Pictures, MapsComeClose) {
  struct Case {
    Scene scene;
    std::size_t paths;
    double mean;
  };
  const std::vector<Case> cases = {{test::own_scene("cornell_box.scene"), 140, 0.0005},
                                   {test::own_scene("two_rooms.scene"), 140, 0.0005},
                                   {test::room_of_balls(16, 16), 32, 0.0005},
                                   {exhibition(), 96, 0.0005}};
  for (const Case& tested : cases) {
    RenderOptions options = small(tested.paths);
    const Image exact = picture(tested.scene, options, Backend::kGl);
    options.shadows = ShadowMethod::kMaps;
    const Image by_maps = picture(tested.scene, options, Backend::kGl);
    EXPECT_LT(mean_difference(by_maps, exact), tested.mean);
  }
}

/// The sky alone shines in, through lattices of windows whose bars are a hand wide: in maps of all
/// of the scene, of 126 m, they would be lost.
TEST(Pictures, MapsComeCloseInsideSibenikUnderTheSky) {
  RenderOptions options = small(24);
  const std::optional<Scene> scene = nave_under_the_sky(options);
  if (!scene) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  const Image exact = picture(*scene, options, Backend::kGl);
  options.shadows = ShadowMethod::kMaps;
  EXPECT_LT(mean_difference(picture(*scene, options, Backend::kGl), exact), 0.005);
}

/// Capitals and rails are of strips that are more slender than a texel: rays find them by their
/// edges and by going from one to the next.
TEST(Pictures, MapsComeCloseInsideSibenikByItsWindows) {
  RenderOptions options = small(24);
  const std::optional<Scene> scene = nave_by_its_windows(options);
  if (!scene) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  const Image exact = picture(*scene, options, Backend::kGl);
  options.shadows = ShadowMethod::kMaps;
  EXPECT_LT(mean_difference(picture(*scene, options, Backend::kGl), exact), 0.007);
}

TEST(Pictures, MapsAreDrawnTheSameEveryTime) {
  RenderOptions options = small(24);
  options.samples = 2;
  options.shadows = ShadowMethod::kMaps;
  const Scene scene = test::room_of_balls(8, 8);
  const Image once = picture(scene, options, Backend::kGl);
  EXPECT_EQ(picture(scene, options, Backend::kGl).pixels, once.pixels);
}

TEST(Pictures, InterleavedSamplesTakeTurns) {
  // Over sixteen samples every pixel of a tile meets every light.
  const Scene scene = test::own_scene("cornell_box.scene");
  RenderOptions options = small(32);
  options.samples = 16;
  const Image all = picture(scene, options, Backend::kGl);
  options.tile = 4;
  const Image turned = picture(scene, options, Backend::kGl);
  options.samples = 1;
  const Image once = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(turned, all), 0.5 * mean_difference(once, all));
}

TEST(Pictures, ShowTheVolumesOfOneLight) {
  const Scene scene = test::own_scene("cornell_box.scene");
  RenderOptions options = small(8);
  const Image plain = picture(scene, options, Backend::kGl);
  options.show_volumes = 0;
  for (const VolumeMethod method :
       {VolumeMethod::kExact, VolumeMethod::kZPass, VolumeMethod::kZFail}) {
    options.volumes = method;
    const Image shown = picture(scene, options, Backend::kGl);
    // Volumes stand in a part of the picture.
    const double share = differing(shown, plain);
    EXPECT_GT(share, 0.05);
    EXPECT_LT(share, 0.9);
  }
  options.tile = 4;
  const Image shared = picture(scene, options, Backend::kGl);
  options.show_volumes.reset();
  EXPECT_GT(differing(shared, picture(scene, options, Backend::kGl)), 0.05);
  options.show_volumes = 1000;
  EXPECT_THROW(picture(scene, options, Backend::kGl), Error);
}

TEST(Pictures, DealtLightsSmoothEdgesAsAllOfThemDo) {
  const Scene scene = test::own_scene("cornell_box.scene");
  RenderOptions options = small(128);
  options.camera.eye = Vec3(2.78f, 2.0f, -4.0f);  // below the lamp, whose edge outshines all others
  options.camera.target = Vec3(2.78f, 1.4f, 2.8f);
  options.camera.vertical_fov = 0.6f;
  const Image once = picture(scene, options, Backend::kGl);
  options.deal_lights = true;
  EXPECT_EQ(picture(scene, options, Backend::kGl).pixels, once.pixels);  // a sample alone has all
  options.samples = 8;
  const Image dealt = picture(scene, options, Backend::kGl);
  options.deal_lights = false;
  const Image all = picture(scene, options, Backend::kGl);
  options.samples = 32;
  const Image smooth = picture(scene, options, Backend::kGl);
  const double error = compare(dealt, smooth).relmse;
  EXPECT_LT(error, 0.2 * compare(once, smooth).relmse);
  // Every share is much like the whole, or edges would have the colours of few lights. At a point
  // thirty lights are off by a third; at an edge that sees both surfaces eight shares average.
  std::vector<double> tints;
  for (std::size_t i = 0; i < all.pixels.size(); ++i) {
    if (is_black(all.pixels[i])) continue;
    const Rgb ratio = dealt.pixels[i] / all.pixels[i];
    tints.push_back(max_component(glm::abs(ratio / mean_component(ratio) - 1.0f)));
  }
  std::sort(tints.begin(), tints.end());
  EXPECT_LT(tints[tints.size() * 98 / 100], 0.33 / std::sqrt(8.0));
  const Comparison comparison = compare(dealt, all);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(comparison.mean_a[channel] / comparison.mean_b[channel], 1.0, 2e-3);
  }
}

TEST(Pictures, DealtAndInterleavedGoTogether) {
  const Scene scene = test::own_scene("cornell_box.scene");
  RenderOptions options = small(256);
  options.samples = 4;
  const Image all = picture(scene, options, Backend::kGl);
  options.deal_lights = true;
  options.tile = 2;
  const Image both = picture(scene, options, Backend::kGl);
  EXPECT_LT(mean_difference(both, all), 0.02);
  const Comparison comparison = compare(both, all);
  EXPECT_NEAR(comparison.mean_a.g / comparison.mean_b.g, 1.0, 0.005);
}

/// A lamp over a sheet with holes and one that lets half of all rays through.
Scene sheets() {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(6);
  Texture holes;
  holes.width = holes.height = 4;
  for (int i = 0; i < 16; ++i) {
    holes.linear.insert(holes.linear.end(),
                        {1.0f, 1.0f, 1.0f, (i / 4 + i % 4) % 2 == 0 ? 1.0f : 0.0f});
  }
  scene.textures.push_back(holes);
  Material masked, blended;
  masked.reflectance_texture = to_id<TextureId>(0);
  masked.alpha_cutoff = 0.5f;
  blended.reflectance = Rgb(0.8f, 0.3f, 0.2f);
  blended.opacity = 0.5f;
  blended.blend = true;
  for (const Material& material : {masked, blended}) {
    const float x = scene.materials.size() % 2 == 0 ? 0.3f : 2.2f;
    Mesh sheet;
    sheet.material = to_id<MaterialId>(scene.materials.size());
    sheet.positions = {
        {x, 2.2f, 0.5f}, {x + 1.5f, 2.2f, 0.5f}, {x + 1.5f, 2.2f, 3.5f}, {x, 2.2f, 3.5f}};
    sheet.texcoords = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 2.0f}, {0.0f, 2.0f}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = to_id<MeshId>(scene.meshes.size());
    scene.meshes.push_back(sheet);
    scene.materials.push_back(material);
  }
  scene.cameras[0].eye = Vec3(2.0f, 3.6f, 3.9f);
  scene.cameras[0].forward = glm::normalize(Vec3(0.0f, -0.6f, -0.8f));
  return scene;
}

TEST(Pictures, HolesAndVeils) {
  const Scene scene = sheets();
  RenderOptions options = small(80);
  options.samples = 4;
  const Image cpu = coarse(picture(scene, options, Backend::kCpu));
  Scene solid = scene;
  for (Material& material : solid.materials) {
    material.alpha_cutoff.reset();
    material.blend = false;
  }
  const Image without = coarse(picture(solid, options, Backend::kCpu));
  ASSERT_GT(mean_difference(without, cpu), 0.1);
  const auto off = [&] {
    return mean_difference(coarse(picture(scene, options, Backend::kGl)), cpu);
  };
  EXPECT_LT(off(), 0.025);
  options.shadows = ShadowMethod::kMaps;
  EXPECT_LT(off(), 0.025);
  options.tile = 4;
  EXPECT_LT(off(), 0.025);
  options.shadows = ShadowMethod::kVolumes;
  EXPECT_LT(off(), 0.025);
}

/// Half transparent sheets below a small lamp, one over the other, of so many pieces a side.
Scene veils(int sheets, int pieces) {
  Scene scene = test::room_of_balls(8, 8);
  scene.instances.resize(2);
  for (Vec3& corner : scene.meshes[1].positions) {
    corner = glm::mix(Vec3(2.0f, 3.9f, 2.0f), corner, 0.02f);
  }
  scene.materials[2].emission = Rgb(20000.0f);
  scene.materials[0].reflectance = Rgb(0.02f);  // no light but the lamp's
  Material veil;
  veil.opacity = 0.5f;
  veil.blend = true;
  scene.materials.push_back(veil);
  Mesh sheet;
  sheet.material = to_id<MaterialId>(3);
  const auto row = static_cast<std::uint32_t>(pieces) + 1;
  for (std::uint32_t i = 0; i < row * row; ++i) {
    sheet.positions.push_back(Vec3(1.0f, 2.2f, 1.0f) +
                              Vec3(static_cast<float>(i % row), 0.0f, static_cast<float>(i / row)) *
                                  (2.0f / static_cast<float>(pieces)));
    if (i % row == row - 1 || i / row == row - 1) continue;
    sheet.triangles.insert(sheet.triangles.end(),
                           {{i, i + 1, i + row + 1}, {i, i + row + 1, i + row}});
  }
  for (int i = 0; i < sheets; ++i) {
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = to_id<MeshId>(scene.meshes.size());
    instance.transform =
        glm::translate(Mat4(1.0f), Vec3(0.0f, -0.1f * static_cast<float>(i), 0.0f));
  }
  scene.meshes.push_back(sheet);
  scene.cameras[0].eye = Vec3(2.0f, 1.5f, 3.95f);
  scene.cameras[0].forward = glm::normalize(Vec3(0.0f, -0.8f, -1.0f));
  return scene;
}

/// Single pixels, of samples that each have their own chance at one veil; a second one, and pieces
/// too small for rays to find them all, throw a pattern of texels, whose mean is as bright.
TEST(Pictures, VeilsLetTheirShareThrough) {
  struct Case {
    int sheets, pieces;
    double single, coarse;  // bounds on how far pixels and means of 8 x 8 are off
  };
  // 64 chances leave single pixels 3 % off, a pattern of texels 10 %.
  for (const Case& tested :
       {Case{1, 1, 0.05, 0.01}, Case{2, 1, 0.15, 0.04}, Case{1, 200, 0.15, 0.04}}) {
    SCOPED_TRACE(testing::Message() << tested.sheets << ' ' << tested.pieces);
    const Scene scene = veils(tested.sheets, tested.pieces);
    RenderOptions options = small(16);
    options.samples = 64;
    const Image cpu = picture(scene, options, Backend::kCpu);
    options.shadows = ShadowMethod::kMaps;
    const Image gl = picture(scene, options, Backend::kGl);
    EXPECT_LT(mean_difference(gl, cpu), tested.single);
    EXPECT_LT(mean_difference(coarse(gl), coarse(cpu)), tested.coarse);
  }
}

TEST(Pictures, AnUnknownDeviceIsAnError) {
  RenderOptions options = small(4);
  options.gl_device = 1000;
  EXPECT_THROW(picture(test::own_scene("cornell_box.scene"), options, Backend::kGl), Error);
}

TEST(Pictures, ALostContextIsAnError) {
  const auto get_error = epoxy_glGetError;
  epoxy_glGetError = []() -> GLenum { return GL_CONTEXT_LOST; };
  std::string said;
  try {
    picture(test::own_scene("cornell_box.scene"), small(4), Backend::kGl);
  } catch (const Error& e) {
    said = e.what();
  }
  epoxy_glGetError = get_error;
  EXPECT_THAT(said, HasSubstr("the context is lost"));
}

TEST(Pictures, ItEndsWhenToldTo) {
  RenderOptions options = small(4);
  options.backend = Backend::kGl;
  options.passes = 0;
  const StopFlag now{true};
  const Rendered rendered = render(test::own_scene("cornell_box.scene"), options, now);
  EXPECT_EQ(rendered.statistics.passes, 1u);
}

}  // namespace
}  // namespace lantern
