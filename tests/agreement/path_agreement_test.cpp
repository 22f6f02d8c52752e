// SPDX-License-Identifier: MIT
// The path tracer against others: instant radiosity, which shares nothing with it but rays, and the
// published reference of the Cornell box.
#include "lantern/core/parallel.h"
#include "lantern/image/read.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/render.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lantern {
namespace {

Scene own_scene(const std::string& name) {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name).scene;
}

Rendered rendered(const Scene& scene, const RenderOptions& options) {
  const StopFlag never{false};
  return render(scene, options, never);
}

/// The sum over some pixels and how many they are.
struct Mean {
  glm::dvec3 sum{0.0};
  double pixels = 0.0;

  void add(const Rgb& pixel) {
    sum += glm::dvec3(pixel);
    ++pixels;
  }
  glm::dvec3 value() const { return sum / pixels; }
};

constexpr int kSize = 48;

/// Pixels that show no lamp: those of lamps are brighter by far, and what counts in them is where
/// each method places its samples.
std::vector<bool> without_lamps(Scene scene) {
  for (Material& material : scene.materials) material.reflectance = Rgb(0.0f);
  RenderOptions options;
  options.method = Method::kPath;
  options.width = options.height = kSize;
  options.samples = 256;
  std::vector<bool> pixels;
  for (const Rgb& pixel : rendered(scene, options).image.pixels) pixels.push_back(is_black(pixel));
  return pixels;
}

using Part = std::vector<std::size_t>;

Mean mean_of(const Image& image, const Part& part) {
  Mean mean;
  for (const std::size_t i : part) mean.add(image.pixels[i]);
  return mean;
}

class PathAgainstInstantRadiosity : public testing::TestWithParam<const char*> {};

TEST_P(PathAgainstInstantRadiosity, PicturesHaveTheSameMeans) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "takes minutes under a sanitizer";
#endif
  const Scene scene = own_scene(GetParam());
  RenderOptions options;
  options.width = options.height = kSize;
  options.method = Method::kPath;
  options.samples = 64;
  options.passes = 16;
  options.path.variance = true;
  const Rendered path = rendered(scene, options);
  RenderOptions lights;
  lights.width = lights.height = kSize;
  lights.passes = 512;
  lights.lights.pool = 16;
  lights.lights.paths = 64;
  lights.bound = 5.0f;
  lights.compensate = true;
  const Image instant = rendered(scene, lights).image;

  // The whole, and nine parts that show different surfaces.
  std::vector<Part> parts(10);
  const std::vector<bool> wanted = without_lamps(scene);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!wanted[i]) continue;
    constexpr std::size_t kThird = kSize / 3;
    parts[0].push_back(i);
    parts[1 + i / kSize / kThird * 3 + i % kSize / kThird].push_back(i);
  }
  for (const Part& part : parts) {
    // Pixels share their lights, whose noise no picture tells of itself: with other seeds the whole
    // scatters by 0.2 %, the darkest parts of the two rooms by 1 %. That of the path tracer is
    // known; a pixel with a candle's bright spot is the worst.
    const bool whole = &part == parts.data();
    const double tolerance = whole ? 0.0075 : 0.03;
    constexpr double kSigmas = 4.0;
    const glm::dvec3 expected = mean_of(path.image, part).value();
    const glm::dvec3 found = mean_of(instant, part).value();
    const Mean variance = mean_of(*path.variance, part);
    const glm::dvec3 error = glm::sqrt(variance.value() / variance.pixels);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(found[channel], expected[channel],
                  kSigmas * error[channel] + tolerance * expected[channel])
          << "channel " << channel << " of part " << &part - parts.data();
      if (whole) {
        EXPECT_NEAR(found[channel], expected[channel], 0.01 * expected[channel]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, PathAgainstInstantRadiosity,
                         testing::Values("cornell_box.scene", "two_rooms.scene",
                                         "many_emitters.scene"),
                         [](const auto& scene) {
                           const std::string name = scene.param;
                           return name.substr(0, name.find('.'));
                         });

/// A half float keeps eleven bits: values are off by up to 2^-11 of themselves, evenly.
double rounding_variance(double value) { return value * value * std::ldexp(1.0, -22) / 3.0; }

TEST(PathCornellBox, ReachesTheReferenceWithinItsOwnVariance) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "takes minutes under a sanitizer";
#endif
  const auto folder = test::shared_folder("reference");
  if (!folder) GTEST_SKIP() << "the shared folder reference is not there";
  const Image reference = read_image(*folder / "cornell_box.exr");
  RenderOptions options;
  options.method = Method::kPath;
  options.width = reference.width;
  options.height = reference.height;
  options.samples = 2;
  options.passes = 16;
  options.path.variance = true;
  const Rendered path = rendered(own_scene("cornell_box.scene"), options);

  // Pixels are independent: so are the sums over blocks of them, whose deviations are as good as
  // normal. The reference's own noise is 6.5e-6 in relmse, 8192 samples where this has 32: less
  // than a hundredth of what is claimed here, and its rounding is less still.
  constexpr int kBlock = 16;
  const auto mean_of_block = [](const Image& image, int x0, int y0) {
    Mean mean;
    for (int y = y0; y < y0 + kBlock; ++y) {
      for (int x = x0; x < x0 + kBlock; ++x) mean.add(image.at(x, y));
    }
    return mean.value();
  };
  constexpr double kReferenceNoise = 6.5e-6;
  double squares = 0.0, sum = 0.0;
  int count = 0;
  for (int y = 0; y < reference.height; y += kBlock) {
    for (int x = 0; x < reference.width; x += kBlock) {
      const glm::dvec3 a = mean_of_block(path.image, x, y);
      const glm::dvec3 b = mean_of_block(reference, x, y);
      const glm::dvec3 variance = mean_of_block(*path.variance, x, y);
      for (int channel = 0; channel < 3; ++channel) {
        const double others =
            kReferenceNoise * (b[channel] * b[channel] + 0.01) + rounding_variance(b[channel]);
        const double deviation =
            (a[channel] - b[channel]) / std::sqrt((variance[channel] + others) / (kBlock * kBlock));
        squares += deviation * deviation;
        sum += deviation;
        ++count;
      }
    }
  }
  RecordProperty("mean_square", std::to_string(squares / count));
  RecordProperty("mean", std::to_string(sum / count));
  // 1024 blocks; their three channels share the paths, so that they count as one. The mean square
  // of standard normal numbers scatters by sqrt(2 / 1024) = 0.044 around one, the mean by 0.031.
  EXPECT_NEAR(squares / count, 1.0, 4.0 * 0.044);
  EXPECT_NEAR(sum / count, 0.0, 4.0 * 0.031);
}

}  // namespace
}  // namespace lantern
