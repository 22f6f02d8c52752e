// SPDX-License-Identifier: MIT
#include "lantern/core/hash.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/resample.h"
#include "lantern/lights/walk.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"

#include "tests/analytic/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numbers>
#include <ostream>

namespace lantern {
namespace {

using test::PassMean;
using test::Receiver;
using test::Stage;
using ::testing::Each;
using ::testing::SizeIs;

constexpr double kPi64 = std::numbers::pi;

/// A mean over passes may be this many standard errors off: with fixed seeds and a few thousand
/// comparisons right code fails one of them for one seed in ten.
constexpr double kErrors = 4.5;
/// What a sum of floats of one sign, each of a few roundings, may be off by.
constexpr double kRounding = 1e-5;

VirtualLights lights_of(const Stage& stage, const WalkOptions& options) {
  return walk(stage.scene, stage.world, *stage.tracer, stage.emitters, options);
}

double start_flux(const VirtualLights& lights) { return test::flux_of_bounce(lights, 0); }

void expect_mean(const PassMean& mean, double expected, const std::string& what) {
  EXPECT_NEAR(mean.mean(), expected,
              kErrors * mean.standard_error() + kRounding * std::abs(expected))
      << what;
}

// --- the flux of the bounces
// -----------------------------------------------------------------------------

constexpr float kEmission = 2.0f;
const Vec3 kBoxSize(2.0f, 1.5f, 2.5f);

struct Walk {
  std::size_t paths;
  float reflectance;
  float survival;
  Sampler sampler;
};

void PrintTo(const Walk& w, std::ostream* out) {
  constexpr std::array kSamplers = {"halton", "scrambled", "random"};
  *out << "N " << w.paths << ", a " << w.reflectance << ", p " << w.survival << ", "
       << kSamplers[static_cast<std::size_t>(w.sampler)];
}

class BounceFluxTest : public ::testing::TestWithParam<Walk> {};

TEST_P(BounceFluxTest, OfEveryBounceIsAPowerOfTheReflectance) {
  const Walk& w = GetParam();
  const Stage stage(test::box_room(kBoxSize, w.reflectance, kEmission));
  const double flux = kPi64 * kEmission * test::total_area(stage.world);
  WalkOptions options;
  options.paths = w.paths;
  options.reflectivity = w.survival;
  options.points = {w.sampler, 0};
  constexpr std::size_t kPasses = 1600;
  constexpr std::size_t kBounces = 64;
  std::vector<PassMean> means(kBounces, PassMean(kPasses));
  for (options.pass = 0; options.pass < kPasses; ++options.pass) {
    const VirtualLights lights = lights_of(stage, options);
    const Survival survival = make_survival(w.paths, w.survival, options.pass);
    std::array<double, kBounces> sums{};
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (lights.bounce[i] < kBounces) {
        sums[lights.bounce[i]] += static_cast<double>(lights.flux[i].g);
      }
    }
    for (std::size_t j = 0; j < kBounces; ++j) {
      means[j].add(sums[j]);
      // While the next generation cannot be empty nothing is left to chance.
      const bool sure = j == 0 || (j - 1 < survival.paths.size() &&
                                   static_cast<float>(survival.paths[j - 1]) * w.survival >= 1.0f);
      if (!sure) {
        for (std::size_t k = j + 1; k < kBounces; ++k) means[k].add(sums[k]);
        break;
      }
      const double expected = flux * std::pow(static_cast<double>(w.reflectance), j);
      ASSERT_NEAR(sums[j], expected, kRounding * expected)
          << "bounce " << j << " of pass " << options.pass;
    }
  }
  // Deeper than this fewer than some hundred passes reach a bounce, and errors of a mean over so
  // few cannot be measured.
  for (std::size_t j = 0; j < kBounces; ++j) {
    const double reached = std::pow(static_cast<double>(w.survival), static_cast<double>(j)) *
                           static_cast<double>(w.paths);
    if (reached < 0.25) {
      EXPECT_GT(j, 2u);
      break;
    }
    const double expected =
        flux * std::pow(static_cast<double>(w.reflectance), static_cast<double>(j));
    expect_mean(means[j], expected, "bounce " + std::to_string(j));
  }
}

std::vector<Walk> walks() {
  std::vector<Walk> all;
  for (const std::size_t paths : {16, 32, 36, 60, 64}) {
    all.push_back({paths, 0.5f, 0.5f, Sampler::kHalton});
    all.push_back({paths, 0.9f, 0.9f, Sampler::kHalton});
    all.push_back({paths, 0.3f, 0.6f, Sampler::kHalton});
  }
  all.push_back({16, 0.8f, 0.7f, Sampler::kScrambled});
  all.push_back({16, 0.8f, 0.7f, Sampler::kRandom});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Boxes, BounceFluxTest, ::testing::ValuesIn(walks()));

TEST(Walk, LeavesOneHundredAndFortyThreeLightsInAClosedRoom) {
  const Stage stage(test::box_room(kBoxSize, 0.6f, kEmission));
  WalkOptions options;
  options.paths = 60;
  options.reflectivity = 0.6f;
  const VirtualLights lights = lights_of(stage, options);
  ASSERT_EQ(lights.size(), 143u);
  std::map<std::uint32_t, int> of_bounce;
  for (const std::uint32_t bounce : lights.bounce) ++of_bounce[bounce];
  EXPECT_THAT(of_bounce,
              ::testing::ElementsAre(std::pair(0u, 60), std::pair(1u, 36), std::pair(2u, 21),
                                     std::pair(3u, 12), std::pair(4u, 7), std::pair(5u, 4),
                                     std::pair(6u, 2), std::pair(7u, 1)));
  EXPECT_EQ(lights.paths, 60u);
}

TEST(Walk, SortsItsLightsByPathThenBounce) {
  const Stage stage(test::box_room(kBoxSize, 0.6f, kEmission));
  WalkOptions options;
  options.paths = 200;
  options.reflectivity = 0.6f;
  options.pass = 3;
  const VirtualLights lights = lights_of(stage, options);
  for (std::size_t i = 1; i < lights.size(); ++i) {
    const bool next_path = lights.path[i] == lights.path[i - 1] + 1 && lights.bounce[i] == 0;
    const bool next_bounce =
        lights.path[i] == lights.path[i - 1] && lights.bounce[i] == lights.bounce[i - 1] + 1;
    EXPECT_TRUE(next_path || next_bounce) << "light " << i;
  }
}

TEST(Walk, SurvivorsComeFromEverywhere) {
  // Emitters in a row along x, so that x of a start is the first coordinate of its path: with
  // Halton the low digits of its number. Were the survivors always the same ranks of a pass, they
  // would always start in the same places.
  Scene scene;
  const MaterialId lamp = test::add_material(scene, 0.5f, 1.0f);
  constexpr int kLamps = 64;
  for (int i = 0; i < kLamps; ++i) {
    test::add_mesh(scene, lamp, {{i, 0, 0}, {i + 1, 0, 0}, {i, 0, 1}},
                   {{0, 1, 2}});  // the front is below
  }
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(-1e3f, -1, -1e3f),
                 Vec3(0, 0, 2e3f), Vec3(2e3f, 0, 0));
  const Stage stage(std::move(scene));
  for (const std::size_t paths : {16, 32, 36, 60, 64}) {
    WalkOptions options;
    options.paths = paths;
    options.reflectivity = 0.3f;
    constexpr std::size_t kPasses = 4000;
    PassMean mean(kPasses);
    std::vector<double> visits(kLamps);
    double survivors = 0.0;
    for (options.pass = 0; options.pass < kPasses; ++options.pass) {
      const VirtualLights lights = lights_of(stage, options);
      double sum = 0.0, count = 0.0;
      for (std::size_t i = 1; i < lights.size(); ++i) {
        if (lights.bounce[i] != 1) continue;
        const float x = lights.position[i - 1].x;
        sum += static_cast<double>(x) / kLamps;
        count += 1.0;
        visits[static_cast<std::size_t>(x)] += 1.0;
      }
      mean.add(sum / count);
      survivors += count;
    }
    // A start lies at a third of its triangle, a sixth left of the middle.
    expect_mean(mean, 0.5 - 1.0 / 6.0 / kLamps, "N = " + std::to_string(paths));
    EXPECT_LT(mean.standard_error(), 0.005);
    // Each lamp expects survivors / 64, about 300 to 1200; their deviation is no more than that of
    // independent visits. Five of those keep 64 lamps in five runs.
    const double expected = survivors / kLamps;
    for (const double n : visits) EXPECT_NEAR(n, expected, 5.0 * std::sqrt(expected));
  }
}

TEST(Survival, ExpectsAPowerOfTheShareAtEveryBounce) {
  for (const std::size_t paths : {16, 36, 60, 64}) {
    for (const float p : {0.3f, 0.6f, 0.9f}) {
      constexpr std::size_t kPasses = 8000;
      constexpr std::size_t kBounces = 24;
      std::vector<PassMean> counts(kBounces, PassMean(kPasses));
      std::vector<PassMean> weights(kBounces, PassMean(kPasses));
      for (std::size_t pass = 0; pass < kPasses; ++pass) {
        const Survival survival = make_survival(paths, p, pass);
        ASSERT_EQ(survival.paths[0], paths);
        for (std::size_t j = 0; j < kBounces; ++j) {
          const bool reached = j < survival.paths.size();
          const double n = reached ? static_cast<double>(survival.paths[j]) : 0.0;
          counts[j].add(n);
          weights[j].add(reached ? n * survival.weight[j] : 0.0);
        }
      }
      for (std::size_t j = 0; j < kBounces; ++j) {
        const double reached =
            std::pow(static_cast<double>(p), static_cast<double>(j)) * static_cast<double>(paths);
        if (reached < 0.05) break;
        const std::string what = "N " + std::to_string(paths) + ", bounce " + std::to_string(j);
        expect_mean(counts[j], reached, what);
        expect_mean(weights[j], 1.0, what);
      }
    }
  }
}

// --- Lambert's polygons
// ----------------------------------------------------------------------------------

struct Polygon {
  const char* name;
  std::vector<Vec3> corners;  // the front looks down
};

void PrintTo(const Polygon& polygon, std::ostream* out) { *out << polygon.name; }

class PolygonTest : public ::testing::TestWithParam<Polygon> {};

TEST_P(PolygonTest, IrradianceIsLambertsWithinItsVariance) {
  const std::vector<Vec3>& corners = GetParam().corners;
  Scene scene;
  std::vector<uvec3> triangles;
  for (std::uint32_t i = 2; i < corners.size(); ++i) triangles.emplace_back(0, i - 1, i);
  test::add_mesh(scene, test::add_material(scene, 0.5f, kEmission), corners, triangles);
  const Stage stage(std::move(scene));
  std::vector<Receiver> receivers;
  for (int i = 0; i < kPacket; ++i) {
    const Vec3 normal = glm::normalize(Vec3(0.2f * static_cast<float>(i % 3 - 1), 1.0f, 0.1f));
    receivers.push_back({Vec3(0.5f * static_cast<float>(i % 4) - 0.8f, 0.0f,
                              0.4f * static_cast<float>(i / 4) - 0.6f),
                         normal});
  }
  const double area = test::total_area(stage.world);
  for (const Sampler sampler : {Sampler::kHalton, Sampler::kScrambled, Sampler::kRandom}) {
    for (const std::size_t paths : {256, 4096, 65536}) {
      WalkOptions options;
      options.paths = paths;
      options.points = {sampler, 0};
      const VirtualLights lights = lights_of(stage, options);
      ASSERT_EQ(lights.size(), paths);
      const std::vector<Rgb> irradiance = test::irradiance_at(stage, lights, receivers);
      double square = 0.0;  // of the errors, in standard errors of independent points
      for (std::size_t r = 0; r < receivers.size(); ++r) {
        const glm::dvec3 x(receivers[r].position), n(receivers[r].normal);
        std::vector<glm::dvec3> seen;
        for (const Vec3& corner : corners) seen.push_back(glm::dvec3(corner) - x);
        const double expected = test::polygon_irradiance(seen, n, kEmission);
        // The variance of one light's share L G A, from the lights themselves.
        double mean_of_squares = 0.0;
        for (std::size_t i = 0; i < paths; ++i) {
          const glm::dvec3 d = glm::dvec3(lights.position[i]) - x;
          const double d2 = glm::dot(d, d);
          const double share = kEmission * area * std::max(0.0, glm::dot(n, d)) *
                               std::max(0.0, -glm::dot(glm::dvec3(lights.normal[i]), d)) /
                               (d2 * d2);
          mean_of_squares += share * share / static_cast<double>(paths);
        }
        const double deviation = std::sqrt(std::max(0.0, mean_of_squares - expected * expected));
        const double error = deviation / std::sqrt(static_cast<double>(paths));
        const double off = static_cast<double>(irradiance[r].g) - expected;
        EXPECT_NEAR(off, 0.0, kErrors * error + kRounding * expected)
            << "receiver " << r << ", N " << paths;
        square += off * off / (error * error) / kPacket;
      }
      // Quasi-random points must be worth their name: far better than independent ones.
      if (sampler != Sampler::kRandom && paths >= 4096) {
        EXPECT_LT(std::sqrt(square), 0.25);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Emitters, PolygonTest,
    ::testing::Values(
        Polygon{
            "rectangle overhead",
            {{-0.5f, 1.5f, -0.7f}, {0.6f, 1.5f, -0.7f}, {0.6f, 1.5f, 0.4f}, {-0.5f, 1.5f, 0.4f}}},
        Polygon{"tilted triangle", {{-0.3f, 1.1f, -0.5f}, {0.9f, 2.0f, 0.0f}, {-0.2f, 1.4f, 0.9f}}},
        Polygon{
            "partly below the horizon",
            {{1.5f, -0.8f, -1.0f}, {1.5f, -0.8f, 1.0f}, {1.7f, 1.2f, 1.0f}, {1.7f, 1.2f, -1.0f}}}));

// --- lights without area, the sky
// --------------------------------------------------------------------

/// A floor in the plane y = 0 that faces up.
Scene floor_of(float half_width, float reflectance) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, reflectance, 0.0f),
                 Vec3(-half_width, 0, -half_width), Vec3(0, 0, 2 * half_width),
                 Vec3(2 * half_width, 0, 0));
  return scene;
}

constexpr Vec3 kUp(0, 1, 0);

std::vector<Receiver> on_the_floor() {
  std::vector<Receiver> receivers;
  for (int i = 0; i < kPacket; ++i) {
    receivers.push_back({Vec3(0.5f * static_cast<float>(i % 4) - 0.7f, 1e-4f,
                              0.5f * static_cast<float>(i / 4) - 0.9f),
                         kUp});
  }
  return receivers;
}

PunctualLight punctual(PunctualKind kind) {
  PunctualLight light;
  light.kind = kind;
  light.intensity = Rgb(3.0f, 2.0f, 1.0f);
  light.position = Vec3(0.3f, 1.25f, -0.2f);
  light.direction = glm::normalize(Vec3(0.2f, -1.0f, 0.1f));
  light.inner_angle = 0.4f;
  light.outer_angle = 0.8f;
  return light;
}

class PunctualTest : public ::testing::TestWithParam<PunctualKind> {};

TEST_P(PunctualTest, IrradianceIsThatOfTheInverseSquareAndTheCosine) {
  Scene scene = floor_of(5.0f, 0.5f);
  const PunctualLight light = punctual(GetParam());
  scene.lights.push_back(light);
  const Stage stage(std::move(scene));
  WalkOptions options;
  options.paths = 16;
  const VirtualLights lights = lights_of(stage, options);
  const std::vector<Receiver> receivers = on_the_floor();
  const std::vector<Rgb> irradiance = test::irradiance_at(stage, lights, receivers);
  int in_the_ring = 0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(light.position) - glm::dvec3(receivers[i].position);
    const glm::dvec3 axis(glm::normalize(light.direction));
    const double distance = glm::length(d);
    double geometry = 0.0;
    switch (GetParam()) {
      case PunctualKind::kPoint:
        geometry = d.y / std::pow(distance, 3);
        break;
      case PunctualKind::kSpot: {
        // The square of a ramp in the cosine, from the outer to the inner angle.
        const double inner = std::cos(0.4), outer = std::cos(0.8);
        const double ramp =
            std::clamp((-glm::dot(axis, d) / distance - outer) / (inner - outer), 0.0, 1.0);
        if (ramp > 0.0 && ramp < 1.0) ++in_the_ring;
        geometry = ramp * ramp * d.y / std::pow(distance, 3);
        break;
      }
      case PunctualKind::kDirectional:
        geometry = -axis.y;
        break;
    }
    for (int c = 0; c < 3; ++c) {
      const double expected = static_cast<double>(light.intensity[c]) * geometry;
      EXPECT_NEAR(static_cast<double>(irradiance[i][c]), expected, kRounding * expected);
    }
  }
  if (GetParam() == PunctualKind::kSpot) {
    EXPECT_GT(in_the_ring, 3);
  }
}

TEST_P(PunctualTest, BouncesTheFluxThatReachesTheFloor) {
  constexpr float kReflectance = 0.4f, kHalfWidth = 5.0f;
  Scene scene = floor_of(kHalfWidth, kReflectance);
  const PunctualLight light = punctual(GetParam());
  scene.lights.push_back(light);
  const Stage stage(std::move(scene));
  double reaches = 0.0;
  switch (GetParam()) {
    case PunctualKind::kPoint: {
      // The solid angle that the floor fills, as Lambert's integral of a unit vector's flux would
      // give it: by midpoints, its integrand smooth at a cell of 1/100 of the height.
      constexpr int kCells = 1000;
      for (int cell = 0; cell < kCells * kCells; ++cell) {
        const glm::dvec3 x(kHalfWidth * (2.0 * (cell % kCells + 0.5) / kCells - 1.0), 0.0,
                           kHalfWidth * (2.0 * (cell / kCells + 0.5) / kCells - 1.0));
        const glm::dvec3 d = glm::dvec3(light.position) - x;
        reaches +=
            d.y / std::pow(glm::length(d), 3) * 4.0 * kHalfWidth * kHalfWidth / (kCells * kCells);
      }
      break;
    }
    case PunctualKind::kSpot: {
      // All of it: 2π ∫ of the squared ramp over the cosine.
      const double inner = std::cos(0.4), outer = std::cos(0.8);
      reaches = 2.0 * kPi64 * ((1.0 - inner) + (inner - outer) / 3.0);
      break;
    }
    case PunctualKind::kDirectional:
      reaches =
          4.0 * kHalfWidth * kHalfWidth * static_cast<double>(-glm::normalize(light.direction).y);
      break;
  }
  WalkOptions options;
  options.paths = 64;
  options.reflectivity = 0.5f;
  constexpr std::size_t kPasses = 1600;
  PassMean mean(kPasses);
  for (options.pass = 0; options.pass < kPasses; ++options.pass) {
    mean.add(test::flux_of_bounce(lights_of(stage, options), 1));
  }
  const double expected = reaches * kReflectance * static_cast<double>(light.intensity.g);
  EXPECT_LT(mean.standard_error() / expected, 0.005);
  expect_mean(mean, expected, "reflected flux");
}

INSTANTIATE_TEST_SUITE_P(Kinds, PunctualTest,
                         ::testing::Values(PunctualKind::kPoint, PunctualKind::kSpot,
                                           PunctualKind::kDirectional));

TEST(Sky, OfOneRadianceMakesPiTimesItOnAnOpenPlane) {
  Scene scene = floor_of(5.0f, 0.4f);
  scene.sky = Sky{.radiance = Rgb(0.5f, 1.0f, 2.0f), .texture = std::nullopt};
  const Stage stage(std::move(scene));
  const std::vector<Receiver> receivers = on_the_floor();
  for (const Sampler sampler : {Sampler::kHalton, Sampler::kRandom}) {
    WalkOptions options;
    options.paths = 65536;
    options.reflectivity = 0.5f;
    options.points = {sampler, 0};
    const VirtualLights lights = lights_of(stage, options);
    // One light's share 4π L cos+ has the mean π L and the mean square 16 π² L² / 6.
    const double deviation = kPi64 * std::sqrt(16.0 / 6.0 - 1.0);
    const double error = deviation / std::sqrt(static_cast<double>(options.paths));
    for (const Rgb& e : test::irradiance_at(stage, lights, receivers)) {
      for (int c = 0; c < 3; ++c) {
        const double radiance = c == 0 ? 0.5 : c == 1 ? 1.0 : 2.0;
        EXPECT_NEAR(static_cast<double>(e[c]) / radiance, kPi64, kErrors * error);
      }
    }
    // Both sides of the floor reflect what falls on them: half the rays come from below. One path's
    // flux at the first bounce has the size 4π L π R² ρ where it hits, with probability
    // cos · (floor's area) / (disc's), which is a half of 100 m² over 50 π m² in the mean.
    const double reflected = 0.4 * 2.0 * kPi64 * 100.0;
    const double ray = 0.4 * 4.0 * kPi64 * kPi64 * 50.0;
    const double share = reflected / ray;
    EXPECT_NEAR(test::flux_of_bounce(lights, 1) / reflected, 1.0,
                kErrors * std::sqrt((1.0 - share) / share / 32768.0));
  }
}

TEST(Sky, WithATextureMakesTheIntegralOfItsRadiance) {
  // Rows get brighter and one corner is bright, so that a flip or a turn of the map would show.
  constexpr int kWidth = 16, kHeight = 8;
  Scene scene = floor_of(5.0f, 0.0f);
  Texture texture;
  texture.width = kWidth;
  texture.height = kHeight;
  texture.wrap_v = Wrap::kClamp;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float value = 0.2f + 0.1f * static_cast<float>(y) + (x >= 3 && x < 6 ? 4.0f : 0.0f);
      texture.linear.insert(texture.linear.end(), {value, 0.5f * value, 0.25f * value, 1.0f});
    }
  }
  scene.textures.push_back(texture);
  scene.sky = Sky{.radiance = Rgb(2.0f), .texture = TextureId{0}};
  const Stage stage(std::move(scene));

  /// The map of scene.h, bilinear between the centres of its texels.
  const auto radiance = [&](double polar, double azimuth) {
    const double u = azimuth / (2.0 * kPi64) * kWidth - 0.5, v = polar / kPi64 * kHeight - 0.5;
    const auto texel_at = [&](int x, int y) {
      const int tx = (x + kWidth) % kWidth, ty = std::clamp(y, 0, kHeight - 1);
      return static_cast<double>(texture.linear[static_cast<std::size_t>(4 * (ty * kWidth + tx))]);
    };
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    const double fx = u - x, fy = v - y;
    return 2.0 * ((1 - fx) * (1 - fy) * texel_at(x, y) + fx * (1 - fy) * texel_at(x + 1, y) +
                  (1 - fx) * fy * texel_at(x, y + 1) + fx * fy * texel_at(x + 1, y + 1));
  };
  for (const Vec3 normal : {kUp, Vec3(1, 0, 0), glm::normalize(Vec3(-1, 1, 0)), Vec3(0, 0.6f, 0.8f),
                            Vec3(0, 0.6f, -0.8f)}) {
    // Above the horizon of the floor alone: the receivers lie on it.
    double expected = 0.0, square = 0.0;
    constexpr int kRows = 400, kColumns = 800;
    for (int row = 0; row < kRows; ++row) {
      const double polar = 0.5 * kPi64 * (row + 0.5) / kRows;
      for (int column = 0; column < kColumns; ++column) {
        const double azimuth = 2.0 * kPi64 * (column + 0.5) / kColumns;
        // u = 0 towards -z, growing over +x.
        const glm::dvec3 way(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                             -std::sin(polar) * std::cos(azimuth));
        const double solid_angle =
            std::sin(polar) * (0.5 * kPi64 / kRows) * (2.0 * kPi64 / kColumns);
        const double value =
            radiance(polar, azimuth) * std::max(0.0, glm::dot(glm::dvec3(normal), way));
        expected += value * solid_angle;
        square += value * solid_angle * value;
      }
    }
    // The sky's directions are chosen nearly in proportion to radiance: a share is cos times the
    // whole sky's ∫ L dω, so its mean square is below expected times that.
    double whole = 0.0;
    for (int row = 0; row < 2 * kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const double polar = 0.5 * kPi64 * (row + 0.5) / kRows;
        whole += radiance(polar, 2.0 * kPi64 * (column + 0.5) / kColumns) * std::sin(polar) *
                 (0.5 * kPi64 / kRows) * (2.0 * kPi64 / kColumns);
      }
    }
    WalkOptions options;
    options.paths = 65536;
    options.points = {Sampler::kRandom, 5};
    const VirtualLights lights = lights_of(stage, options);
    constexpr double kChoiceMargin = 2.0;  // cells take the mean of their corners
    const double error =
        std::sqrt(kChoiceMargin * whole * expected / static_cast<double>(options.paths));
    EXPECT_LT(error / expected, 0.02);
    const std::array receivers = {Receiver{Vec3(0, 1e-3f, 0), normal}};
    const Rgb e = test::irradiance_at(stage, lights, receivers)[0];
    EXPECT_NEAR(static_cast<double>(e.r), expected, kErrors * error);
    EXPECT_NEAR(static_cast<double>(e.g), 0.5 * static_cast<double>(e.r), kRounding * expected);

    options.points = {Sampler::kHalton, 0};
    const Rgb quasi = test::irradiance_at(stage, lights_of(stage, options), receivers)[0];
    EXPECT_NEAR(static_cast<double>(quasi.r), expected, error);
  }
}

// --- emitters
// ---------------------------------------------------------------------------------------------

TEST(Emission, ByTextureHasTheFluxOfTheTexturesMean) {
  Scene scene;
  Texture texture;
  texture.width = texture.height = 5;
  double mean = 0.0;
  for (std::uint64_t i = 0; i < 25; ++i) {
    const float value = to_unit_float(hash(7, i));
    texture.linear.insert(texture.linear.end(), {value, value, value, 1.0f});
    mean += static_cast<double>(value) / 25.0;
  }
  scene.textures.push_back(texture);
  const MaterialId screen = test::add_material(scene, 0.5f, kEmission);
  scene.materials[0].emission_texture = TextureId{0};
  // A repeating texture's bilinear interpolation has the mean of its texels over whole periods.
  test::add_quad(scene, screen, Vec3(0), Vec3(2, 0, 0), Vec3(0, 3, 0));
  const Stage stage(std::move(scene));
  const double expected = kPi64 * 6.0 * kEmission * mean;
  WalkOptions options;
  options.paths = 16;
  constexpr std::size_t kPasses = 3200;
  for (const Sampler sampler : {Sampler::kHalton, Sampler::kRandom}) {
    options.points = {sampler, 0};
    PassMean flux(kPasses);
    for (options.pass = 0; options.pass < kPasses; ++options.pass) {
      flux.add(start_flux(lights_of(stage, options)));
    }
    EXPECT_LT(flux.standard_error() / expected, 0.005);
    expect_mean(flux, expected, "start");
  }
}

TEST(Emission, OfASingleTexelIsNotMissed) {
  // A lamp drawn into a large texture: whatever grid estimates the flux must not lose it.
  constexpr int kSize = 128;
  for (const int lit : {20, 45, 77}) {
    Scene scene;
    Texture texture;
    texture.width = texture.height = kSize;
    texture.linear.assign(4 * kSize * kSize, 0.0f);
    texture.linear[static_cast<std::size_t>(4 * (lit * kSize + lit / 2))] = 100.0f;
    scene.textures.push_back(texture);
    const MaterialId screen = test::add_material(scene, 0.5f, 1.0f);
    scene.materials[0].emission_texture = TextureId{0};
    test::add_quad(scene, screen, Vec3(0), Vec3(2, 0, 0), Vec3(0, 3, 0));
    const Stage stage(std::move(scene));
    ASSERT_FALSE(stage.emitters.empty()) << "texel " << lit;
    WalkOptions options;
    options.paths = 1 << 20;
    double sum = 0.0;
    for (const Rgb& flux : lights_of(stage, options).flux) sum += static_cast<double>(flux.r);
    const double expected = kPi64 * 6.0 * 100.0 / (kSize * kSize);
    // Bilinear, so that the square's mean is (2/3)² of the texel's: of N independent starts the
    // relative error would be sqrt((2/3)² 128² / N) = 0.08. Quasi-random ones keep well below.
    EXPECT_NEAR(sum / expected, 1.0, 0.08) << "texel " << lit;
  }
}

TEST(Emission, LeavesTheBackOfDoubleSidedMaterialsAlone) {
  for (const bool both : {false, true}) {
    Scene scene;
    const MaterialId lamp = test::add_material(scene, 0.5f, kEmission);
    scene.materials[0].double_sided = both;
    test::add_quad(scene, lamp, Vec3(-1, 1, -1), Vec3(0, 0, 2), Vec3(2, 0, 0));  // looks up
    const Stage stage(std::move(scene));
    WalkOptions options;
    options.paths = 4096;
    const VirtualLights lights = lights_of(stage, options);
    double up = 0.0, down = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      (lights.normal[i].y > 0.0f ? up : down) += static_cast<double>(lights.flux[i].g);
    }
    const double side = kPi64 * 4.0 * kEmission;
    EXPECT_NEAR(up, side, kRounding * side);
    EXPECT_NEAR(down, both ? side : 0.0, kRounding * side);
    const std::array receivers = {Receiver{Vec3(0, 2, 0), -kUp}, Receiver{Vec3(0, 0, 0), kUp}};
    const std::vector<Rgb> e = test::irradiance_at(stage, lights, receivers);
    const std::array corners = {glm::dvec3(-1, 1, -1), glm::dvec3(1, 1, -1), glm::dvec3(1, 1, 1),
                                glm::dvec3(-1, 1, 1)};
    const double expected = test::polygon_irradiance(corners, glm::dvec3(0, 1, 0), kEmission);
    EXPECT_NEAR(static_cast<double>(e[0].g), expected, 0.01 * expected);
    EXPECT_NEAR(static_cast<double>(e[1].g), both ? expected : 0.0, 0.01 * expected);
  }
}

TEST(Emission, EntersInProportionToFlux) {
  // Shares of 1.5, 2, 5 and 7.5 sixteenths, of area and of radiance. The first coordinates of the
  // sixteen starts of a pass lie a sixteenth apart, so each share gets its number, rounded either
  // way, and in the mean exactly that.
  Scene scene;
  constexpr std::array<float, 4> kAreas = {1.5f, 1, 5, 2.5f}, kRadiances = {1, 2, 1, 3};
  for (std::size_t i = 0; i < kAreas.size(); ++i) {
    const float x = 10.0f * static_cast<float>(i);
    test::add_mesh(scene, test::add_material(scene, 0.0f, kRadiances[i]),
                   {{x, 0, 0}, {x + 2.0f * kAreas[i], 0, 0}, {x, 1, 0}}, {{0, 1, 2}});
  }
  const Stage stage(std::move(scene));
  EXPECT_NEAR(static_cast<double>(stage.emitters.flux().g), 16.0 * kPi64, 16.0 * kRounding);
  WalkOptions options;
  options.paths = 16;
  constexpr std::size_t kPasses = 1600;
  for (const Sampler sampler : {Sampler::kHalton, Sampler::kScrambled}) {
    options.points = {sampler, 0};
    std::vector<PassMean> means(kAreas.size(), PassMean(kPasses));
    for (options.pass = 0; options.pass < kPasses; ++options.pass) {
      const VirtualLights lights = lights_of(stage, options);
      std::array<int, 4> starts{};
      for (std::size_t i = 0; i < lights.size(); ++i) {
        ++starts[static_cast<std::size_t>(lights.position[i].x / 10.0f)];
        ASSERT_NEAR(static_cast<double>(lights.flux[i].g), kPi64, kRounding * kPi64);
      }
      for (std::size_t i = 0; i < kAreas.size(); ++i) {
        const double share = static_cast<double>(kAreas[i] * kRadiances[i]);
        // In the scrambled sequence a point may lie on either side of its stratum's ends.
        const double either_way = sampler == Sampler::kHalton ? 0.51 : 1.51;
        ASSERT_NEAR(starts[i], share, either_way) << "pass " << options.pass;
        means[i].add(starts[i]);
      }
    }
    for (std::size_t i = 0; i < kAreas.size(); ++i) {
      const double share = static_cast<double>(kAreas[i] * kRadiances[i]);
      expect_mean(means[i], share, "emitter " + std::to_string(i));
      EXPECT_LT(means[i].standard_error(), 0.05);
    }
  }
}

TEST(MeanReflectivity, WeighsByArea) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, 0.9f, 0.0f), Vec3(0), Vec3(1, 0, 0),
                 Vec3(0, 1, 0));
  const MaterialId dark = test::add_material(scene, 0.1f, 0.0f);
  scene.materials[1].reflectance = Rgb(0.0f, 0.1f, 0.2f);
  test::add_quad(scene, dark, Vec3(0, 0, 5), Vec3(3, 0, 0), Vec3(0, 1, 0));
  // An instance counts with its own size: two times two.
  scene.instances.push_back({MeshId{0}, glm::scale(Mat4(1.0f), Vec3(2.0f)), std::nullopt});
  const World world = make_world(scene);
  EXPECT_NEAR(mean_reflectivity(scene, world), (0.9 * 1 + 0.1 * 3 + 0.9 * 4) / 8, 1e-6);
  // Squares: of the channel that has most, area-weighted as well.
  EXPECT_NEAR(mean_squared_reflectance(scene, world), (0.81 * 1 + 0.04 * 3 + 0.81 * 4) / 8, 1e-6);
}

// --- jitter
// -----------------------------------------------------------------------------------------------

TEST(Jitter, MovesAPointByNoMoreThanTheSpacingOfItsGeneration) {
  // Sixteen equal lamps: the first fifteen starts lie on the lower ends of as many strata, so that
  // a step of up to a sixteenth leaves each with its lamp, and a longer one would not.
  Scene scene;
  const MaterialId lamp = test::add_material(scene, 0.0f, 1.0f);
  for (int i = 0; i < 16; ++i) {
    test::add_mesh(scene, lamp, {{2 * i, 0, 0}, {2 * i + 1, 0, 0}, {2 * i, 1, 0}}, {{0, 1, 2}});
  }
  const Stage stage(std::move(scene));
  WalkOptions options;
  options.paths = 16;
  const VirtualLights plain = lights_of(stage, options);
  options.jitter = true;
  const VirtualLights jittered = lights_of(stage, options);
  ASSERT_THAT(jittered.position, SizeIs(16));
  const auto lamp_of = [](const Vec3& position) {
    constexpr float kHair = 1e-3f;  // interpolated corners round to either side
    return static_cast<int>((position.x + kHair) / 2.0f);
  };
  float least = 1.0f, most = 0.0f;
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(lamp_of(jittered.position[i]), lamp_of(plain.position[i]));
    const float moved = jittered.position[i].x - plain.position[i].x;
    least = std::min(least, moved);
    most = std::max(most, moved);
  }
  // All the way, not a part of it: the places on the lamps spread.
  EXPECT_LT(least, 0.1f);
  EXPECT_GT(most, 0.6f);
  double total = 0.0;
  for (const Rgb& flux : jittered.flux) total += static_cast<double>(flux.g);
  EXPECT_NEAR(total, 8.0 * kPi64, 8.0 * kPi64 * kRounding);
}

TEST(Jitter, KeepsTheFluxOfEveryBounceAndTheMean) {
  constexpr float kReflectance = 0.6f;
  const Stage stage(test::box_room(kBoxSize, kReflectance, kEmission));
  const double flux = kPi64 * kEmission * test::total_area(stage.world);
  WalkOptions options;
  options.paths = 60;
  options.reflectivity = kReflectance;
  options.jitter = true;
  std::vector<Receiver> receivers =
      test::receivers_around(stage, Vec3(0.0f),
                             std::array{Vec3(1, 0.1f, 0.2f), Vec3(-0.1f, 1, 0.2f),
                                        Vec3(0.2f, 0.1f, 1), Vec3(0.1f, -1, -0.2f)});
  constexpr std::size_t kSeeds = 2000;
  std::vector<PassMean> means(receivers.size(), PassMean(kSeeds));
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    // Every pass of its own seed: the mean over seeds, not over the sequence.
    options.points.seed = seed;
    options.pass = static_cast<std::size_t>(seed);
    const VirtualLights lights = lights_of(stage, options);
    for (std::uint32_t j = 0; j < 6; ++j) {
      const double expected = flux * std::pow(static_cast<double>(kReflectance), j);
      ASSERT_NEAR(test::flux_of_bounce(lights, j), expected, kRounding * expected);
    }
    const std::vector<Rgb> e = test::irradiance_at(stage, lights, receivers);
    for (std::size_t i = 0; i < means.size(); ++i) means[i].add(static_cast<double>(e[i].g));
  }
  const double expected = kPi64 * kEmission / (1.0 - kReflectance);
  for (const PassMean& mean : means) {
    EXPECT_LT(mean.standard_error() / expected, 0.005);
    expect_mean(mean, expected, "irradiance");
  }
}

// --- a pool of lights
// -------------------------------------------------------------------------------------

double total_flux(const VirtualLights& lights) {
  double sum = 0.0;
  for (const Rgb& flux : lights.flux) sum += static_cast<double>(flux.g);
  return sum;
}

VirtualLights pool_of(const Stage& stage, std::size_t paths) {
  WalkOptions options;
  options.paths = paths;
  options.reflectivity = 0.5f;
  return lights_of(stage, options);
}

TEST(Resample, KeepsTheFluxOfEqualLightsExactly) {
  const Stage stage(test::box_room(kBoxSize, 0.5f, kEmission));
  VirtualLights pool = pool_of(stage, 512);
  for (Rgb& flux : pool.flux) flux = Rgb(2.0f, 1.0f, 0.5f);
  for (const std::size_t count : {1, 7, 64, 500}) {
    for (const std::uint64_t pass : {0, 1, 77}) {
      const VirtualLights few = resample(pool, flux_weights(pool), count, pass);
      EXPECT_LE(few.size(), count);
      EXPECT_GT(few.size(), count / 3);
      EXPECT_NEAR(total_flux(few), total_flux(pool), kRounding * total_flux(pool));
    }
  }
}

TEST(Resample, IsUnbiasedOverPasses) {
  // A pool of unequal, coloured lights: the mean over passes of what a light sends is what it sent.
  const Stage stage(test::box_room(kBoxSize, 0.5f, kEmission));
  VirtualLights pool = pool_of(stage, 64);
  for (std::size_t i = 0; i < pool.size(); ++i) {
    const std::uint64_t key = i;
    pool.flux[i] *= Rgb(0.1f + to_unit_float(hash(1, key)), 0.1f + to_unit_float(hash(2, key)),
                        i % 5 == 0 ? 8.0f : 0.2f);
  }
  constexpr std::size_t kPasses = 1 << 14;
  constexpr std::size_t kCount = 16;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place;
  for (std::size_t i = 0; i < pool.size(); ++i) place[{pool.path[i], pool.bounce[i]}] = i;
  std::vector<glm::dvec3> sums(pool.size(), glm::dvec3(0.0));
  for (std::uint64_t pass = 0; pass < kPasses; ++pass) {
    const VirtualLights few = resample(pool, flux_weights(pool), kCount, pass);
    ASSERT_LE(few.size(), kCount);
    for (std::size_t i = 0; i < few.size(); ++i) {
      const std::size_t from = place.at({few.path[i], few.bounce[i]});
      EXPECT_EQ(few.position[i], pool.position[from]);
      EXPECT_EQ(few.normal[i], pool.normal[from]);
      sums[from] += glm::dvec3(few.flux[i]) / static_cast<double>(kPasses);
    }
  }
  for (std::size_t i = 0; i < pool.size(); ++i) {
    // A light is met while the choice of its stratum is in an interval; over so many passes, a
    // power of two, each end of an interval errs by one at most, over a light's chance to be met.
    for (int c = 0; c < 3; ++c) {
      const double sent = static_cast<double>(pool.flux[i][c]);
      EXPECT_NEAR(sums[i][c] / sent, 1.0, 0.02) << "light " << i;
    }
  }
}

TEST(Resample, SpreadsOverPlaces) {
  // Equal lights in eight corners of a cube: eight of them stand for all, one in each corner.
  VirtualLights pool;
  for (std::uint32_t i = 0; i < 800; ++i) {
    const std::uint64_t key = i;
    const Vec3 corner(i & 1u ? 9.0f : 0.0f, i & 2u ? 9.0f : 0.0f, i & 4u ? 9.0f : 0.0f);
    pool.kind.push_back(LightKind::kSurface);
    pool.position.push_back(corner + Vec3(to_unit_float(hash(1, key)), to_unit_float(hash(2, key)),
                                          to_unit_float(hash(3, key))));
    pool.normal.emplace_back(0, 1, 0);
    pool.flux.emplace_back(1.0f);
    pool.path.push_back(i);
    pool.bounce.push_back(0);
    pool.cone.emplace_back(0.0f);
  }
  for (const std::uint64_t pass : {0, 1, 77}) {
    std::map<std::tuple<bool, bool, bool>, int> met;
    for (const Vec3& p : resample(pool, flux_weights(pool), 8, pass).position) {
      ++met[{p.x > 5.0f, p.y > 5.0f, p.z > 5.0f}];
    }
    EXPECT_THAT(met, SizeIs(8));
  }
}

TEST(Resample, TakesPoolsOfNoneOneAndThoseAtInfinity) {
  EXPECT_EQ(resample(VirtualLights{}, {}, 4, 5).size(), 0u);

  VirtualLights pool;
  const auto add = [&](LightKind kind, const Vec3& position, const Vec3& normal) {
    pool.kind.push_back(kind);
    pool.position.push_back(position);
    pool.normal.push_back(normal);
    pool.flux.emplace_back(1.0f, 0.0f, 3.0f);
    pool.path.push_back(static_cast<std::uint32_t>(pool.path.size()));
    pool.bounce.push_back(0);
    pool.cone.emplace_back(0.9f, 0.5f);
  };
  add(LightKind::kSpot, Vec3(1, 2, 3), Vec3(0, 0, -1));
  for (const std::size_t count : {1, 5}) {
    const VirtualLights one = resample(pool, flux_weights(pool), count, 4);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one.kind[0], LightKind::kSpot);
    EXPECT_EQ(one.cone[0], Vec2(0.9f, 0.5f));
    EXPECT_NEAR(one.flux[0].r, 1.0f, 1e-6f);
    EXPECT_NEAR(one.flux[0].b, 3.0f, 3e-6f);
    EXPECT_EQ(one.flux[0].g, 0.0f);
  }
  for (int i = 0; i < 63; ++i) {
    add(LightKind::kDirectional, Vec3(0.0f),
        glm::normalize(Vec3(static_cast<float>(i) - 31.0f, -20.0f, 5.0f)));
  }
  for (const std::uint64_t pass : {0, 5, 9}) {
    const VirtualLights few = resample(pool, flux_weights(pool), 16, pass);
    EXPECT_LE(few.size(), 16u);
    EXPECT_GE(few.size(), 8u);
    double red = 0.0;
    for (const Rgb& flux : few.flux) red += static_cast<double>(flux.r);
    EXPECT_NEAR(red, 64.0, 64.0 * kRounding);
  }
}

}  // namespace
}  // namespace lantern
