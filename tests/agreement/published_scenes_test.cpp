// SPDX-License-Identifier: MIT
// Pictures of scenes that others made: the Cornell box against a path-traced reference, and Ogre's
// sample meshes.
#include "lantern/core/parallel.h"
#include "lantern/image/compare.h"
#include "lantern/image/read.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/edits.h"
#include "lantern/pipeline/render.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace lantern {
namespace {

Image picture(const Scene& scene, const RenderOptions& options) {
  const StopFlag never{false};
  return render(scene, options, never).image;
}

TEST(CornellBox, ConvergesToTheReference) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "takes minutes under a sanitizer";
#endif
  const auto folder = test::shared_folder("reference");
  if (!folder) GTEST_SKIP() << "the shared folder reference is not there";
  const Image reference = read_image(*folder / "cornell_box.exr");
  const Scene scene =
      load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/cornell_box.scene").scene;
  RenderOptions options;
  options.width = reference.width;
  options.height = reference.height;
  options.lights.paths = 32;
  options.lights.pool = 16;
  options.bound = 5.0f;
  options.compensate = true;

  options.passes = 8;
  const Comparison few = compare(picture(scene, options), reference);
  options.passes = 256;
  const Comparison many = compare(picture(scene, options), reference);
  RecordProperty("relmse", std::to_string(many.relmse));
  // The reference's own noise is 6.5e-6. After 64 passes relmse is 1.2e-4 already, but the means of
  // several equally good sequences still scatter by 0.3 %: a quarter of that is left here.
  EXPECT_LT(many.relmse, 3e-4);
  // Independent passes would gain a factor of 32; the half of it allows for luck with the few.
  EXPECT_LT(many.relmse, few.relmse / 16.0);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(many.mean_a[channel] / many.mean_b[channel], 1.0, 0.003) << channel;
  }
}

class OgreSamplesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::shared_folder("scenes/ogre");
    if (!folder) GTEST_SKIP() << "the shared folder scenes/ogre is not there";
    folder_ = *folder;
    options_.width = 160;
    options_.height = 120;
    options_.lights.paths = 64;
    options_.bound = 50.0f;
  }

  /// Finite, and light nearly everywhere.
  static void expect_lit(const Image& image) {
    std::size_t lit = 0;
    for (const Rgb& pixel : image.pixels) {
      ASSERT_TRUE(is_finite(pixel));
      lit += is_black(pixel) ? 0 : 1;
    }
    EXPECT_GT(lit, image.pixels.size() * 9 / 10);
  }

  std::filesystem::path folder_;
  RenderOptions options_;
};

TEST_F(OgreSamplesTest, CornellUnderASky) {
  Loaded loaded = load_scene(folder_ / "cornell.mesh");
  EXPECT_THAT(loaded.report.warnings, testing::IsEmpty());
  EXPECT_THAT(loaded.report.unknown, testing::IsEmpty());
  set_sky({}, loaded.scene);
  expect_lit(picture(loaded.scene, options_));
}

TEST_F(OgreSamplesTest, SibenikUnderSunAndSky) {
  Loaded loaded = load_scene(folder_ / "sibenik.mesh");
  // Its triangles without area are real.
  EXPECT_THAT(loaded.report.warnings, testing::Each(testing::HasSubstr("triangles without area")));
  EXPECT_THAT(loaded.report.unknown, testing::IsEmpty());
  set_sky({}, loaded.scene);
  PunctualLight sun;
  sun.kind = PunctualKind::kDirectional;
  sun.intensity = Rgb(20.0f);
  sun.direction = glm::normalize(Vec3(0.3f, -1.0f, 0.2f));
  loaded.scene.lights.push_back(sun);
  expect_lit(picture(loaded.scene, options_));
}

}  // namespace
}  // namespace lantern
