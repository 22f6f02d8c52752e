// SPDX-License-Identifier: MIT
// Shadow volumes against shadow rays, light by light and pixel by pixel, from the very points that
// GL drew.
#include "lantern/core/hash.h"
#include "lantern/gl/context.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/rasteriser.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"

#include "tests/gl/apis.h"
#include "tests/raster/raster_scenes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lantern {
namespace {

constexpr int kWidth = 96, kHeight = 96;

/// What shadow rays say of what masks say.
struct Difference {
  std::size_t pixels = 0;    // of all lights
  std::size_t compared = 0;  // could be lit at all
  std::size_t lit = 0;
  std::size_t wrong = 0;
  double share() const { return static_cast<double>(wrong) / static_cast<double>(pixels); }
};

struct Both {
  const test::RasterStage& stage;
  gl::ShaderFiles files;
  Surfaces surfaces;
  StencilShadows shadows;
  StageTimes times;
  GBuffer g_buffer;
  gl::Texture mask;
  gl::Framebuffer framebuffer = gl::Framebuffer({&mask}, &g_buffer.depth);
  ClipRange range;

  Both(const test::RasterStage& with, VolumeMethod method, ClipRange depths, int width = kWidth,
       int height = kHeight)
      : stage(with),
        surfaces(with.scene, with.world, files),
        shadows(with.world, files, method),
        g_buffer(width, height),
        mask(gl::Format::kRgba8, width, height),
        range(depths) {}

  View view_of(const Camera& camera) const {
    return make_view(camera, {.width = mask.width(),
                              .height = mask.height(),
                              .offset = Vec2(0.3f, 0.6f),
                              .radius = stage.world.bounds.radius(),
                              .range = range});
  }

  /// The masks of these lights; none is seen where there is no surface.
  std::vector<std::uint8_t> draw(const Camera& camera, std::span<const LightPoint> lights) {
    const View view = view_of(camera);
    surfaces.draw(view, g_buffer);
    shadows.draw(lights, view, framebuffer, times);
    auto masks = framebuffer.read<std::uint8_t>();
    const auto emissions = g_buffer.framebuffer.read<float>(2);
    for (std::size_t i = 0; i < masks.size(); ++i) {
      if (emissions[i / 4 * 4 + 3] == 0.0f) masks[i] = 0;
    }
    return masks;
  }

  Difference compare(const Camera& camera, const VirtualLights& lights) {
    const View view = view_of(camera);
    surfaces.draw(view, g_buffer);
    g_buffer.framebuffer.bind();
    const auto points = g_buffer.framebuffer.read<std::uint32_t>(0);
    const auto emissions = g_buffer.framebuffer.read<float>(2);
    Difference difference;
    for (const LightGroup& group : group_lights(lights, {}, stage.world.coordinate_scale())) {
      shadows.draw(group.points, view, framebuffer, times);
      const auto masks = framebuffer.read<std::uint8_t>();
      for (std::size_t pixel = 0; pixel < masks.size() / 4; ++pixel) {
        difference.pixels += group.points.size();
        if (emissions[4 * pixel + 3] == 0.0f) continue;
        const auto word = [&](std::size_t i) {
          return std::bit_cast<float>(points[4 * pixel + i]);
        };
        const Vec3 position(word(0), word(1), word(2));
        const Vec3 normal = unpack(points[4 * pixel + 3]);
        for (std::size_t light = 0; light < group.points.size(); ++light) {
          compare_one(group, light, position, normal,
                      (masks[4 * pixel + light / 8] >> (light % 8) & 1) != 0, difference);
        }
      }
    }
    return difference;
  }

  void compare_one(const LightGroup& group, std::size_t light, const Vec3& position,
                   const Vec3& normal, bool seen, Difference& difference) const {
    const LightPoint& point = group.points[light];
    const Vec3 way = Vec3(point) - point.w * position;
    // Where surface or light look away from each other nobody asks, nor where they do but for the
    // rounding of the packed normal.
    constexpr float kGrazing = 1e-4f;
    if (glm::dot(normal, way) < kGrazing * glm::length(way)) return;
    if (group.formula == LightFormula::kSurface &&
        -glm::dot(Vec3(group.records[light].axis), way) < kGrazing * glm::length(way)) {
      return;
    }
    Ray ray;
    ray.origin = position;
    ray.direction = way;
    ray.far = point.w != 0.0f ? 1.0f : kInfinity;
    const bool lit = !stage.tracer->occluded(ray);
    ++difference.compared;
    difference.lit += lit ? 1 : 0;
    difference.wrong += lit != seen ? 1 : 0;
  }

  /// The inverse of shaders/octahedral.glsl.
  static Vec3 unpack(std::uint32_t bits) {
    const Vec2 p = Vec2(static_cast<float>(bits & 0xffffu), static_cast<float>(bits >> 16)) *
                       (2.0f / 65534.0f) -
                   1.0f;
    Vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0f) {
      n.x = (1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f);
      n.y = (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f);
    }
    return glm::normalize(n);
  }
};

/// Rasterisers move corners to a grid of 1/256 of a pixel: along the edges of shadows and of
/// surfaces, which cross a few hundred pixels, so small a share falls to the other side.
constexpr double kEdges = 0.0005;

/// Of a single view a light or two may run along an edge; an eye that is on the wrong side of a
/// volume's quad would have half its pixels wrong.
constexpr double kOneView = 0.005;

void expect_same(const test::RasterStage& stage, VolumeMethod method, std::size_t paths,
                 const std::vector<Camera>& cameras, ClipRange range = ClipRange::kFarIs0) {
  Both both(stage, method, range);
  const VirtualLights lights = stage.lights(paths);
  Difference all;
  for (const Camera& camera : cameras) {
    const Difference d = both.compare(camera, lights);
    EXPECT_LT(d.share(), kOneView)
        << "from " << camera.eye.x << ' ' << camera.eye.y << ' ' << camera.eye.z;
    all.pixels += d.pixels;
    all.compared += d.compared;
    all.lit += d.lit;
    all.wrong += d.wrong;
  }
  EXPECT_LT(all.share(), kEdges);
  EXPECT_GT(all.lit, all.pixels / 20);
  EXPECT_GT(all.compared, all.lit);
}

class ShadowsTest : public ::testing::TestWithParam<gl::Api> {
 protected:
  gl::Context context_{{.api = GetParam(), .device = {}}};
};
INSTANTIATE_TEST_SUITE_P(Apis, ShadowsTest, ::testing::Values(gl::Api::kDesktop, gl::Api::kEs));

TEST_P(ShadowsTest, CornellBox) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  expect_same(stage, VolumeMethod::kExact, 40, stage.scene.cameras);
}

TEST_P(ShadowsTest, CornellBoxFromAnywhere) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  expect_same(stage, VolumeMethod::kExact, 40, test::random_cameras(stage.world.bounds, 24));
}

TEST_P(ShadowsTest, TwoRooms) {
  const test::RasterStage stage(test::own_scene("two_rooms.scene"));
  expect_same(stage, VolumeMethod::kExact, 40, test::random_cameras(stage.world.bounds, 24));
}

TEST_P(ShadowsTest, Balls) {
  const test::RasterStage stage(test::room_of_balls(16, 16));
  std::vector<Camera> cameras = test::random_cameras(stage.world.bounds, 8);
  cameras.push_back(stage.scene.cameras.front());
  expect_same(stage, VolumeMethod::kExact, 20, cameras);
}

TEST_P(ShadowsTest, FromBehindTheSame) {
  const test::RasterStage cornell(test::own_scene("cornell_box.scene"));
  expect_same(cornell, VolumeMethod::kZFail, 20, test::random_cameras(cornell.world.bounds, 6));
  const test::RasterStage balls(test::room_of_balls(8, 8));
  expect_same(balls, VolumeMethod::kZFail, 10, test::random_cameras(balls.world.bounds, 6));
}

/// How the masks of two methods differ, light by light.
struct Masks {
  int light_here = 0;  // pixels lit by the first
  int differ = 0;
  int lit_by_both = 0;
};
Masks masks_of(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
               std::size_t light) {
  Masks masks;
  for (std::size_t pixel = 0; pixel < a.size() / 4; ++pixel) {
    const auto lit = [&](std::span<const std::uint8_t> mask) {
      return (mask[4 * pixel + light / 8] >> (light % 8) & 1) != 0;
    };
    masks.light_here += lit(a) ? 1 : 0;
    masks.differ += lit(a) != lit(b) ? 1 : 0;
    masks.lit_by_both += lit(a) && lit(b) ? 1 : 0;
  }
  return masks;
}

TEST_P(ShadowsTest, ClassicZPassIsRightJustOutsideOfAllVolumes) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  Both exact(stage, VolumeMethod::kExact, ClipRange::kFarIs0);
  Both z_pass(stage, VolumeMethod::kZPass, ClipRange::kFarIs0);
  const EdgeList list(stage.world);
  const VirtualLights lights = stage.lights(16);
  const LightGroup group = group_lights(lights, {}, stage.world.coordinate_scale()).front();
  int inside = 0, outside = 0;
  for (const Camera& camera : test::random_cameras(stage.world.bounds, 8)) {
    const auto right = exact.draw(camera, group.points);
    const auto classic = z_pass.draw(camera, group.points);
    for (std::size_t light = 0; light < group.points.size(); ++light) {
      const Masks masks = masks_of(right, classic, light);
      const int around_eye =
          list.volumes(group.points[light], camera.eye, VolumeCount::kPlain).eye_count;
      if (around_eye == 0) {
        EXPECT_LE(masks.differ, kOneView * kWidth * kHeight) << light;
        outside += masks.light_here;
      } else {
        // What is lit has left the eye's volumes, and the count that started too low is not 0.
        EXPECT_LE(masks.lit_by_both, kOneView * kWidth * kHeight) << light;
        inside += masks.light_here;
      }
    }
  }
  EXPECT_GT(outside, kWidth * kHeight);
  EXPECT_GT(inside, kWidth * kHeight);
}

TEST_P(ShadowsTest, TheSidesThatAreShownSumUpToLightAndShadow) {
  const test::RasterStage stage(test::room_of_balls(8, 8));
  Both z_pass(stage, VolumeMethod::kZPass, ClipRange::kFarIs0);
  const VirtualLights lights = stage.lights(4);
  const LightGroup group = group_lights(lights, {}, stage.world.coordinate_scale()).front();
  for (const Camera& camera : test::random_cameras(stage.world.bounds, 4)) {
    const auto masks = z_pass.draw(camera, group.points);
    for (std::size_t light = 0; light < group.points.size(); ++light) {
      z_pass.shadows.draw_sides(group.points[light], z_pass.view_of(camera), z_pass.framebuffer);
      const auto sides = z_pass.framebuffer.read<std::uint8_t>();
      int wrong = 0;
      for (std::size_t pixel = 0; pixel < sides.size() / 4; ++pixel) {
        const bool lit = (masks[4 * pixel + light / 8] >> (light % 8) & 1) != 0;
        wrong += lit != (sides[4 * pixel] == sides[4 * pixel + 1]) ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0) << light;
    }
  }
}

TEST_P(ShadowsTest, ZFailIsTheSameEverywhere) {
  const test::RasterStage stage(test::own_scene("two_rooms.scene"));
  Both exact(stage, VolumeMethod::kExact, ClipRange::kFarIs0);
  Both z_fail(stage, VolumeMethod::kZFail, ClipRange::kFarIs0);
  const VirtualLights lights = stage.lights(16);
  const LightGroup group = group_lights(lights, {}, stage.world.coordinate_scale()).front();
  for (const Camera& camera : test::random_cameras(stage.world.bounds, 8)) {
    const auto right = exact.draw(camera, group.points);
    const auto behind = z_fail.draw(camera, group.points);
    for (std::size_t light = 0; light < group.points.size(); ++light) {
      EXPECT_LE(masks_of(right, behind, light).differ, kOneView * kWidth * kHeight) << light;
    }
  }
}

/// Every second column and row, each of the four with lights of its own, from eyes that different
/// numbers of their volumes are around.
TEST_P(ShadowsTest, ViewsSideBySideSeeWhatEachSeesByItself) {
  constexpr int kStep = 2, kPart = kWidth / kStep;
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  const LightGroup group =
      group_lights(stage.lights(16), {}, stage.world.coordinate_scale()).front();
  const std::array<std::size_t, 4> counts = {3, 7, 5, 6};
  ASSERT_GE(group.points.size(), 21u);
  for (const VolumeMethod method : {VolumeMethod::kExact, VolumeMethod::kZFail}) {
    Both together(stage, method, ClipRange::kFarIs0);
    Both alone(stage, method, ClipRange::kFarIs0, kPart, kPart);
    std::size_t wrong = 0, lit = 0, compared = 0;
    for (const Camera& camera : test::random_cameras(stage.world.bounds, 8)) {
      std::vector<View> views;
      std::vector<LightsInView> lights;
      views.reserve(counts.size());
      std::size_t first_light = 0;
      for (int share = 0; share < 4; ++share) {
        const glm::ivec2 first(share % kStep, share / kStep);
        views.push_back(make_view(camera, {.width = kWidth,
                                           .height = kHeight,
                                           .step = kStep,
                                           .first = first,
                                           .origin = first * kPart,
                                           .radius = stage.world.bounds.radius()}));
        const std::size_t count = counts[static_cast<std::size_t>(share)];
        lights.push_back({views.back(), std::span(group.points).subspan(first_light, count)});
        first_light += count;
        together.surfaces.draw(views.back(), together.g_buffer);
      }
      together.shadows.draw(lights, together.framebuffer, together.times);
      const auto masks = together.framebuffer.read<std::uint8_t>();
      for (std::size_t share = 0; share < 4; ++share) {
        View view = views[share];
        view.origin = glm::ivec2(0);
        alone.surfaces.draw(view, alone.g_buffer);
        alone.shadows.draw(lights[share].lights, view, alone.framebuffer, alone.times);
        const auto own = alone.framebuffer.read<std::uint8_t>();
        const glm::ivec2 origin = views[share].origin;
        for (int y = 0; y < kPart; ++y) {
          for (int x = 0; x < kPart; ++x) {
            const auto at = static_cast<std::size_t>((origin.y + y) * kWidth + origin.x + x);
            const unsigned asked = (1u << counts[share]) - 1u;
            const unsigned there = own[4 * static_cast<std::size_t>(y * kPart + x)] & asked;
            wrong += static_cast<std::size_t>(std::popcount((masks[4 * at] & asked) ^ there));
            lit += static_cast<std::size_t>(std::popcount(there));
            compared += counts[share];
          }
        }
      }
    }
    EXPECT_LT(static_cast<double>(wrong), kEdges * static_cast<double>(compared));
    EXPECT_GT(lit, compared / 20);
  }
}

TEST_P(ShadowsTest, WithoutClipControl) {
  const test::RasterStage stage(test::own_scene("cornell_box.scene"));
  const std::vector<Camera> cameras = test::random_cameras(stage.world.bounds, 6);
  expect_same(stage, VolumeMethod::kExact, 20, cameras, ClipRange::kFarIs1);
  expect_same(stage, VolumeMethod::kZFail, 20, cameras, ClipRange::kFarIs1);
}

/// Small pictures from very many places: what goes wrong with the eye, rather than with the edges,
/// shows as a whole light's pixels.
struct Anywhere {
  const char* name;
  Scene (*scene)();
  std::size_t paths;
};
void PrintTo(const Anywhere& tested, std::ostream* out) { *out << tested.name; }

class HundredCameras : public ::testing::TestWithParam<Anywhere> {};
INSTANTIATE_TEST_SUITE_P(
    In, HundredCameras,
    ::testing::Values(Anywhere{"CornellBox", [] { return test::own_scene("cornell_box.scene"); },
                               40},
                      Anywhere{"TwoRooms", [] { return test::own_scene("two_rooms.scene"); }, 30},
                      Anywhere{"Balls", [] { return test::room_of_balls(8, 8); }, 10}),
    [](const ::testing::TestParamInfo<Anywhere>& tested) { return tested.param.name; });

TEST_P(HundredCameras, SeeWhatShadowRaysSee) {
  constexpr int kSize = 32, kCameras = 100;
  const gl::Context context;
  const test::RasterStage stage(GetParam().scene());
  Both both(stage, VolumeMethod::kExact, ClipRange::kFarIs0, kSize, kSize);
  const VirtualLights lights = stage.lights(GetParam().paths);
  const EdgeList list(stage.world);
  Difference all;
  std::size_t pairs = 0, inside = 0;
  for (const Camera& camera : test::random_cameras(stage.world.bounds, kCameras)) {
    const Difference d = both.compare(camera, lights);
    EXPECT_LT(d.share(), kOneView)
        << "from " << camera.eye.x << ' ' << camera.eye.y << ' ' << camera.eye.z;
    all.pixels += d.pixels;
    all.lit += d.lit;
    all.wrong += d.wrong;
    for (const LightGroup& group : group_lights(lights, {}, stage.world.coordinate_scale())) {
      for (const LightPoint& light : group.points) {
        inside += list.volumes(light, camera.eye, VolumeCount::kPlain).eye_count != 0 ? 1 : 0;
        ++pairs;
      }
    }
  }
  RecordProperty("wrong_of_a_million", static_cast<int>(1e6 * all.share()));
  EXPECT_LT(all.share(), kEdges);
  EXPECT_GT(all.lit, all.pixels / 20);
  // Eyes in volumes and eyes in none.
  EXPECT_GT(inside, pairs / 10);
  EXPECT_LT(inside, pairs * 9 / 10);
}

TEST_P(ShadowsTest, Sibenik) {
  const auto folder = test::shared_folder("scenes/ogre");
  if (!folder) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
  Scene scene = load_scene(*folder / "sibenik.mesh").scene;
  Bounds all;
  for (const Vec3& p : make_world(scene).positions) all.add(p);
  PunctualLight lamp;
  lamp.position = all.centre();
  scene.lights.push_back(lamp);
  const test::RasterStage stage(std::move(scene));
  Bounds box = stage.world.bounds;
  expect_same(stage, VolumeMethod::kExact, 10, test::random_cameras(box, 4));
}

}  // namespace
}  // namespace lantern
