// SPDX-License-Identifier: MIT
#include "lantern/core/hash.h"
#include "lantern/gather/gather.h"
#include "lantern/gather/kernel_isa.h"
#include "lantern/lights/resample.h"
#include "lantern/lights/walk.h"
#include "lantern/pipeline/render.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/brute_force.h"

#include "tests/analytic/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <ostream>

namespace lantern {
namespace {

using test::PassMean;
using test::Receiver;
using test::Stage;

// --- the furnace
// -----------------------------------------------------------------------------------------
// In a closed room whose walls all emit E and reflect a, the radiance is E / (1 - a) everywhere:
// the sum over j of what is reflected j times, E a^j. The lights send all of it but what the camera
// sees of the emission directly: an irradiance of π E / (1 - a).

enum class Room { kBox, kSphere };

constexpr float kEmission = 1.5f;
const Vec3 kBoxSize(2.0f, 2.4f, 2.2f);

Scene furnace(Room room, float reflectance) {
  constexpr int kSplits = 2;  // 128 faces
  return room == Room::kBox ? test::box_room(kBoxSize, reflectance, kEmission)
                            : test::sphere_room(kSplits, reflectance, kEmission);
}

/// Sixteen points of the walls: in the box half a metre or more from its edges, on the sphere at
/// the centres of its faces. At a distance h from an edge the geometry term reaches 0.32 / h², and
/// without a bound the variance of a single light grows with it.
std::vector<Receiver> furnace_receivers(const Stage& stage, Room room) {
  std::vector<Vec3> directions;
  for (std::uint32_t i = 0; i < kPacket; ++i) {
    if (room == Room::kSphere) {
      const std::uint32_t face =
          i * (static_cast<std::uint32_t>(stage.world.size()) / kPacket) + i % 8;
      const uvec3 v = stage.world.triangles[face];
      directions.push_back(
          (stage.world.positions[v.x] + stage.world.positions[v.y] + stage.world.positions[v.z]) /
          3.0f);
      continue;
    }
    const Vec2 u(static_cast<float>(radical_inverse(2, i + 1)),
                 static_cast<float>(radical_inverse(3, i + 1)));
    const int axis = static_cast<int>(i) % 3;
    Vec3 direction(0.0f);
    direction[axis] = i % 2 == 0 ? 1.0f : -1.0f;
    direction[(axis + 1) % 3] = u.x - 0.5f;
    direction[(axis + 2) % 3] = u.y - 0.5f;
    directions.push_back(direction);
  }
  return test::receivers_around(stage, Vec3(0.0f), directions);
}

struct Furnace {
  Room room;
  float reflectance;
  float survival;  // the walk's p; 0: computed from the scene
  std::size_t paths;
  Sampler sampler;
  std::size_t pool;
};

void PrintTo(const Furnace& f, std::ostream* out) {
  constexpr std::array kSamplers = {"halton", "scrambled", "random"};
  *out << (f.room == Room::kBox ? "box" : "sphere") << ", a " << f.reflectance << ", p "
       << f.survival << ", N " << f.paths << ", " << kSamplers[static_cast<std::size_t>(f.sampler)]
       << ", pool " << f.pool;
}

class FurnaceTest : public ::testing::TestWithParam<Furnace> {};

constexpr double kClaim = 0.01;  // relative, of the issue
/// The claim is this many standard errors wide, so that a right renderer meets it: with sixteen
/// points in each of a hundred rooms, one in ten seeds would exceed four somewhere.
constexpr double kClaimInErrors = 4.0;

/// How many passes make the standard error small enough. One path's share of the irradiance has the
/// relative variance v (1-a)² Σ (a²/p)^j = v (1-a)² / (1 - a²/p), where v is that of one light in
/// the place of all: A ∫G² / π² - 1, with G the geometry term. The last of a pass's paths carries
/// up to 1/N of the light and goes on for a random while, which makes that vary by about itself.
std::size_t passes_for(const Furnace& f, float p) {
  const double v = f.room == Room::kBox ? 2.0 : 0.1;
  const double a = static_cast<double>(f.reflectance);
  const double n = static_cast<double>(f.paths);
  const double of_path = v * (1 - a) * (1 - a) / (1 - a * a / static_cast<double>(p));
  constexpr double kMargin = 2.0;  // the errors, being measured, err as well
  const double of_pass = of_path / n + kMargin / (n * n);
  const double error = kClaim / kClaimInErrors;
  return static_cast<std::size_t>(of_pass / (error * error)) + 1;
}

/// Each mean is within the claim, and the claim is wide enough for their noise to be no excuse.
void expect_everywhere(std::span<const PassMean> means, double expected) {
  double square = 0.0;
  for (const PassMean& mean : means) {
    EXPECT_NEAR(mean.mean() / expected, 1.0, kClaim);
    const double error = mean.standard_error() / expected;
    square += error * error / static_cast<double>(means.size());
  }
  EXPECT_LT(std::sqrt(square), kClaim / kClaimInErrors);
}

VirtualLights furnace_lights(const Stage& stage, const Furnace& f, float p, std::size_t pass) {
  WalkOptions options;
  options.paths = f.paths * f.pool;
  options.reflectivity = p;
  options.pass = pass;
  options.points = {f.sampler, 0};
  VirtualLights lights = walk(stage.scene, stage.world, *stage.tracer, stage.emitters, options);
  if (f.pool == 1) return lights;
  return resample(lights, flux_weights(lights), lights.size() / f.pool, pass);
}

TEST_P(FurnaceTest, IrradianceOfEveryPointIsThatOfTheGeometricSeries) {
  const Furnace& f = GetParam();
  const Stage stage(furnace(f.room, f.reflectance));
  const std::vector<Receiver> receivers = furnace_receivers(stage, f.room);
  const float p = f.survival > 0.0f ? f.survival : mean_reflectivity(stage.scene, stage.world);
  const std::size_t passes = passes_for(f, p);
  std::vector<PassMean> means(receivers.size(), PassMean(passes));
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const VirtualLights lights = furnace_lights(stage, f, p, pass);
    const std::vector<Rgb> irradiance = test::irradiance_at(stage, lights, receivers);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      means[i].add(static_cast<double>(irradiance[i].g));
    }
  }
  const double expected = std::numbers::pi * kEmission / (1.0 - f.reflectance);
  expect_everywhere(means, expected);
}

std::vector<Furnace> furnaces() {
  constexpr float kComputed = 0.0f;
  std::vector<Furnace> all;
  for (const Room room : {Room::kBox, Room::kSphere}) {
    for (const Sampler sampler : {Sampler::kHalton, Sampler::kScrambled, Sampler::kRandom}) {
      for (const float a : {0.2f, 0.5f, 0.9f}) {
        all.push_back({room, a, kComputed, 16, sampler, 1});
      }
      all.push_back({room, 0.9f, 0.95f, 16, sampler, 1});
    }
    for (const auto& [a, p] :
         {std::pair(0.2f, 0.5f), std::pair(0.5f, 0.75f), std::pair(0.9f, 0.92f)}) {
      all.push_back({room, a, p, 16, Sampler::kHalton, 1});
    }
    for (const float a : {0.2f, 0.5f, 0.9f})
      all.push_back({room, a, kComputed, 16, Sampler::kHalton, 4});
  }
  // Multiples of the sequence's bases and their powers, where survivors could share digits.
  for (const std::size_t paths : {32, 36, 60, 64}) {
    all.push_back({Room::kBox, 0.9f, kComputed, paths, Sampler::kHalton, 1});
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Rooms, FurnaceTest, ::testing::ValuesIn(furnaces()));

/// A corner of the box fills the picture, so the bound takes much at every pixel.
struct CornerPicture {
  Stage stage;
  Camera camera;
  GatherOptions options;

  CornerPicture(float reflectance, float bound, bool compensate)
      : stage(furnace(Room::kBox, reflectance)) {
    camera.eye = Vec3(0.1f, -0.2f, 0.05f);
    camera.forward = glm::normalize(-0.5f * kBoxSize - camera.eye);
    camera.vertical_fov = 1.2f;
    options.width = options.height = 4;
    options.bound = bound;
    options.compensate = compensate;
  }

  std::vector<PassMean> render(const WalkOptions& walk_with, std::size_t passes) {
    std::vector<PassMean> means(static_cast<std::size_t>(options.width * options.height),
                                PassMean(passes));
    WalkOptions with = walk_with;
    GatherCounts counts;
    const StopFlag stop{false};
    for (with.pass = 0; with.pass < passes; ++with.pass) {
      options.pass = with.pass;
      const VirtualLights lights =
          walk(stage.scene, stage.world, *stage.tracer, stage.emitters, with);
      const Image image = gather({stage.scene, stage.world, *stage.tracer, stage.emitters, camera},
                                 lights, options, counts, stop);
      for (std::size_t i = 0; i < means.size(); ++i) {
        means[i].add(static_cast<double>(image.pixels[i].g));
      }
    }
    return means;
  }
};

class CompensatedFurnaceTest : public ::testing::TestWithParam<std::tuple<float, Sampler>> {};

TEST_P(CompensatedFurnaceTest, EveryPixelAroundACornerIsThatOfTheGeometricSeries) {
  const auto [a, sampler] = GetParam();
  // Long chains of close hits, which much reflectance and a low bound make, need more passes.
  const bool bright = a > 0.8f;
  CornerPicture picture(a, bright ? 5.0f : 1.0f, true);
  const std::size_t passes = bright ? 14000 : 4000;
  WalkOptions walk_with;
  walk_with.paths = 16;
  walk_with.reflectivity = a;
  walk_with.points = {sampler, 0};
  expect_everywhere(picture.render(walk_with, passes), kEmission / (1.0 - a));
}
INSTANTIATE_TEST_SUITE_P(Rooms, CompensatedFurnaceTest,
                         ::testing::Combine(::testing::Values(0.2f, 0.5f, 0.9f),
                                            ::testing::Values(Sampler::kHalton, Sampler::kScrambled,
                                                              Sampler::kRandom)));

TEST(CompensatedFurnace, LosesNothingInLongChainsOfCloseHits) {
  // So low a bound leaves nearly all to rays from hit to hit, many of them ended by roulette. What
  // single pixels show is noisy; their mean is not.
  constexpr float kReflectance = 0.9f, kBound = 0.1f;
  CornerPicture picture(kReflectance, kBound, true);
  WalkOptions walk_with;
  walk_with.paths = 16;
  walk_with.reflectivity = kReflectance;
  double mean = 0.0, square = 0.0;
  const std::vector<PassMean> pixels = picture.render(walk_with, 1600);
  for (const PassMean& pixel : pixels) {
    const double share = 1.0 / static_cast<double>(pixels.size());
    mean += pixel.mean() * share;
    square += pixel.standard_error() * pixel.standard_error() * share;
  }
  const double expected = kEmission / (1.0 - kReflectance);
  EXPECT_NEAR(mean / expected, 1.0, kClaim);
  // Rays of different pixels are independent, and nearly all comes from them.
  EXPECT_LT(std::sqrt(square / static_cast<double>(pixels.size())) / expected,
            kClaim / kClaimInErrors);
}

TEST(BoundedFurnace, EveryPixelIsBelowTheGeometricSeriesInTheMean) {
  // A single pass may lie above it, as any estimate may: the bound is a promise about the mean over
  // passes, which is an integral of min(G, b) <= G.
  constexpr float kReflectance = 0.5f, kBound = 1.0f;
  CornerPicture picture(kReflectance, kBound, false);
  WalkOptions walk_with;
  walk_with.paths = 16;
  walk_with.reflectivity = kReflectance;
  const double expected = kEmission / (1.0 - kReflectance);
  for (const PassMean& mean : picture.render(walk_with, 1000)) {
    EXPECT_LT(mean.mean() + kClaimInErrors * mean.standard_error(), expected);
    EXPECT_GT(mean.mean(), kEmission);  // which the camera sees whatever the bound
  }
}

TEST(BoundedFurnace, IrradianceIsTheIntegralOfTheBoundedGeometryTerm) {
  constexpr float kReflectance = 0.5f;
  const Stage stage(furnace(Room::kBox, kReflectance));
  const std::vector<Receiver> receivers = furnace_receivers(stage, Room::kBox);
  for (const double bound : {0.05, 0.2, 0.6}) {  // of geometry terms around π / A = 0.11
    const Furnace f{Room::kBox, kReflectance, 0.0f, 16, Sampler::kHalton, 1};
    const std::size_t passes = passes_for(f, kReflectance);
    std::vector<PassMean> means(receivers.size(), PassMean(passes));
    for (std::size_t pass = 0; pass < passes; ++pass) {
      const std::vector<Rgb> irradiance =
          test::irradiance_at(stage, furnace_lights(stage, f, kReflectance, pass), receivers,
                              static_cast<float>(bound));
      for (std::size_t i = 0; i < means.size(); ++i) {
        means[i].add(static_cast<double>(irradiance[i].g));
      }
    }
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      // Midpoint rule over every wall; its error, second order in a cell of 1/100 of a wall, is
      // below 1e-4 of the claim's 1e-2.
      double integral = 0.0;
      const glm::dvec3 x(receivers[i].position), n(receivers[i].normal);
      for (const Mesh& wall : stage.scene.meshes) {
        const glm::dvec3 corner(wall.positions[0]), u(wall.positions[1] - wall.positions[0]),
            v(wall.positions[3] - wall.positions[0]);
        const glm::dvec3 area_vector = glm::cross(u, v);
        constexpr int kCells = 100;
        for (int cell = 0; cell < kCells * kCells; ++cell) {
          const glm::dvec3 d = corner + u * ((cell % kCells + 0.5) / kCells) +
                               v * ((cell / kCells + 0.5) / kCells) - x;
          const double square = glm::dot(d, d);
          const double term = std::max(0.0, glm::dot(n, d)) *
                              std::max(0.0, -glm::dot(glm::normalize(area_vector), d)) /
                              (square * square);
          integral += std::min(term, bound) * glm::length(area_vector) / (kCells * kCells);
        }
      }
      const double expected = kEmission / (1.0 - kReflectance) * integral;
      EXPECT_NEAR(means[i].mean() / expected, 1.0, kClaim) << "bound " << bound << ", point " << i;
    }
  }
}

TEST(Compensation, IsNotTiedToThePlaceInThePixel) {
  // One pixel shows a floor beside a bright wall. Were the compensating ray's direction a function
  // of the place in the pixel, each seed would have a limit of its own, up to a tenth off.
  Scene scene;
  constexpr float kReflectance = 0.5f;
  const MaterialId floor = test::add_material(scene, kReflectance, 0.0f);
  const MaterialId wall = test::add_material(scene, 0.0f, 1.0f);
  test::add_quad(scene, floor, Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0));
  test::add_quad(scene, wall, Vec3(0), Vec3(0, 1, 0), Vec3(0, 0, 1));
  const Stage stage(std::move(scene));
  constexpr float kHalfView = 0.49f;
  Camera camera;
  camera.eye = Vec3(0.5f, 1.0f, 0.5f);
  camera.forward = Vec3(0, -1, 0);
  camera.up = Vec3(0, 0, 1);
  camera.vertical_fov = 2.0f * std::atan(kHalfView);

  // The view factor of two unit squares with a common edge, from the part of the floor in view to
  // the wall, by Lambert's formula at a grid of points.
  double expected = 0.0;
  constexpr int kCells = 200;
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    const double x = 0.5 + kHalfView * (2.0 * (cell % kCells + 0.5) / kCells - 1.0);
    const double z = 0.5 + kHalfView * (2.0 * (cell / kCells + 0.5) / kCells - 1.0);
    const std::array<glm::dvec3, 4> corners = {glm::dvec3(-x, 0, -z), glm::dvec3(-x, 1, -z),
                                               glm::dvec3(-x, 1, 1 - z), glm::dvec3(-x, 0, 1 - z)};
    expected += kReflectance / std::numbers::pi *
                test::polygon_irradiance(corners, glm::dvec3(0, 1, 0), 1.0) / (kCells * kCells);
  }
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    GatherOptions options;
    options.width = options.height = 1;
    options.bound = 1.0f;
    options.compensate = true;
    options.seed = seed;
    WalkOptions walk_with;
    walk_with.paths = 16;
    walk_with.reflectivity = 0.3f;
    GatherCounts counts;
    const StopFlag stop{false};
    constexpr std::size_t kPasses = 50000;
    PassMean mean(kPasses);
    for (walk_with.pass = 0; walk_with.pass < kPasses; ++walk_with.pass) {
      options.pass = walk_with.pass;
      const VirtualLights lights =
          walk(stage.scene, stage.world, *stage.tracer, stage.emitters, walk_with);
      const Image image = gather({stage.scene, stage.world, *stage.tracer, stage.emitters, camera},
                                 lights, options, counts, stop);
      mean.add(static_cast<double>(image.pixels[0].g));
    }
    EXPECT_NEAR(mean.mean() / expected, 1.0, kClaim) << "seed " << seed;
    EXPECT_LT(mean.standard_error() / expected, kClaim / kClaimInErrors);
  }
}

// --- through render()
// ------------------------------------------------------------------------------------

RenderOptions corner_view(std::size_t passes) {
  RenderOptions options;
  options.width = options.height = 4;
  options.bound = 5.0f;
  options.compensate = true;
  options.passes = passes;
  options.lights.paths = 16;
  options.camera.eye = Vec3(0.1f, -0.2f, 0.05f);
  options.camera.target = -0.5f * kBoxSize;
  return options;
}

TEST(Render, PooledLightsSatisfyTheFurnaceAtEveryPixel) {
  for (const float a : {0.5f, 0.9f}) {
    // As many passes as keep the compensated furnace above, without a pool, within the claim.
    RenderOptions options = corner_view(a < 0.9f ? 2500 : 10000);
    options.lights.pool = 4;
    const Rendered rendered = render(furnace(Room::kBox, a), options, StopFlag{false});
    EXPECT_THAT(rendered.warnings, ::testing::IsEmpty());
    const double expected = kEmission / (1.0 - a);
    for (const Rgb& pixel : rendered.image.pixels) {
      EXPECT_NEAR(static_cast<double>(pixel.g) / expected, 1.0, kClaim);
    }
  }
}

TEST(Render, WarnsOfAReflectivityBelowTheSquareOfTheReflectances) {
  const Scene scene = furnace(Room::kBox, 0.9f);
  RenderOptions options = corner_view(1);
  options.lights.reflectivity = 0.80f;  // 0.9² = 0.81
  EXPECT_THAT(render(scene, options, StopFlag{false}).warnings,
              ::testing::ElementsAre(::testing::HasSubstr("variance")));
  options.lights.reflectivity = 0.82f;
  EXPECT_THAT(render(scene, options, StopFlag{false}).warnings, ::testing::IsEmpty());
  options.lights.reflectivity = std::nullopt;
  EXPECT_THAT(render(scene, options, StopFlag{false}).warnings, ::testing::IsEmpty());
}

// --- the kernel
// ------------------------------------------------------------------------------------------

/// Uniform in [0, 1), a stream for each test.
class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}
  float operator()() { return to_unit_float(hash(seed_, count_++)); }
  Vec3 in_cube() {
    const float x = (*this)(), y = (*this)(), z = (*this)();
    return 2.0f * Vec3(x, y, z) - 1.0f;
  }
  Vec3 direction() {
    while (true) {
      const Vec3 v = in_cube();
      if (glm::length(v) > 0.1f && glm::length(v) < 1.0f) return glm::normalize(v);
    }
  }

 private:
  std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

/// Forty triangles in a cube, to throw shadows.
Scene debris() {
  Scene scene;
  const MaterialId grey = test::add_material(scene, 0.5f, 0.0f);
  Random random(11);
  for (int i = 0; i < 40; ++i) {
    const Vec3 at = random.in_cube();
    test::add_mesh(scene, grey,
                   {at, at + 0.3f * random.direction(), at + 0.3f * random.direction()},
                   {{0, 1, 2}});
  }
  return scene;
}

VirtualLights lights_of_all_kinds() {
  VirtualLights lights;
  Random random(12);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto kind = static_cast<LightKind>(i % 4);
    lights.kind.push_back(kind);
    lights.position.push_back(kind == LightKind::kDirectional ? Vec3(0.0f) : random.in_cube());
    lights.normal.push_back(random.direction());
    lights.flux.emplace_back(random(), random(), random());
    lights.path.push_back(i);
    lights.bounce.push_back(0);
    lights.cone.push_back(kind == LightKind::kSpot ? Vec2(0.8f, 0.1f) : Vec2(0.0f));
  }
  return lights;
}

/// Sixteen different points, each with its own two normals.
ShadingPacket scattered_points() {
  ShadingPacket packet{};
  Random random(13);
  for (int i = 0; i < kPacket; ++i) {
    const Vec3 p = random.in_cube(), geometric = random.direction();
    const Vec3 shading = glm::normalize(geometric + 0.7f * random.direction());
    packet.x[i] = p.x;
    packet.y[i] = p.y;
    packet.z[i] = p.z;
    packet.shading_x[i] = shading.x;
    packet.shading_y[i] = shading.y;
    packet.shading_z[i] = shading.z;
    packet.geometric_x[i] = geometric.x;
    packet.geometric_y[i] = geometric.y;
    packet.geometric_z[i] = geometric.z;
    packet.active.lane[i] = i == 5 ? 0 : -1;  // one lane idles
  }
  return packet;
}

/// The definitions of virtual_lights.h, point by point, light by light, in double precision.
glm::dvec3 plain_irradiance(const VirtualLights& lights, const ShadingPacket& points, int i,
                            const Tracer& tracer, float scale, double bound) {
  const glm::dvec3 x(points.x[i], points.y[i], points.z[i]);
  const glm::dvec3 shading(points.shading_x[i], points.shading_y[i], points.shading_z[i]);
  const glm::dvec3 geometric(points.geometric_x[i], points.geometric_y[i], points.geometric_z[i]);
  glm::dvec3 sum(0.0);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const glm::dvec3 normal(lights.normal[l]), flux(lights.flux[l]);
    const bool far = lights.kind[l] == LightKind::kDirectional;
    const bool surface = lights.kind[l] == LightKind::kSurface;
    const Vec3 lifted = off_surface(lights.position[l], lights.normal[l], scale);
    const glm::dvec3 to = far ? -normal : glm::dvec3(surface ? lifted : lights.position[l]) - x;
    const double distance = glm::length(to), cos_x = glm::dot(shading, to) / distance;
    const double cos_y = -glm::dot(normal, to) / distance;
    if (cos_x <= 0.0 || glm::dot(geometric, to) <= 0.0) continue;
    glm::dvec3 share(0.0);
    if (surface) {
      const double term = cos_x * std::max(0.0, cos_y) / (distance * distance);
      share = flux / std::numbers::pi * std::min(term, bound);
    } else if (far) {
      share = flux * cos_x;
    } else {
      const Vec2 cone = lights.cone[l];
      const bool spot = lights.kind[l] == LightKind::kSpot;
      const double ramp =
          std::clamp((cos_y - static_cast<double>(cone.y)) /
                         (static_cast<double>(cone.x) - static_cast<double>(cone.y)),
                     0.0, 1.0);
      // ∫ of the squared ramp over the cosine: the full cone and a third of the ring around it.
      const double solid_angle =
          spot
              ? 2.0 * std::numbers::pi *
                    (1.0 - static_cast<double>(cone.x) + static_cast<double>(cone.x - cone.y) / 3.0)
              : 4.0 * std::numbers::pi;
      share = flux * ((spot ? ramp * ramp : 1.0) / solid_angle * cos_x / (distance * distance));
    }
    if (share == glm::dvec3(0.0)) continue;
    const Ray ray{.origin = Vec3(x), .direction = Vec3(to), .far = far ? kInfinity : 1.0f};
    if (!tracer.occluded(ray)) sum += share;
  }
  return sum;
}

class KernelTest : public ::testing::Test {
 protected:
  KernelTest() : stage_(debris()), lights_(lights_of_all_kinds()), points_(scattered_points()) {}

  /// Each light errs by some roundings of a float and the sum by one of its value each.
  static constexpr double kRounding = 200 * 0x1p-24;

  Stage stage_;
  VirtualLights lights_;
  ShadingPacket points_;
};

TEST_F(KernelTest, EqualsAPlainLoopOverPointsAndLights) {
  const auto brute_force = make_brute_force_tracer(stage_.scene, stage_.world);
  const float scale = stage_.world.coordinate_scale();
  const GatherLights ready(lights_, scale);
  for (const Tracer* tracer : {stage_.tracer.get(), brute_force.get()}) {
    for (const ShadowRays rays : {ShadowRays::kPackets, ShadowRays::kSingle}) {
      for (const float bound : {kInfinity, 0.5f}) {
        IrradiancePacket irradiance;
        gather_irradiance(ready, points_, *tracer, bound, rays, irradiance);
        int lit = 0;
        for (int i = 0; i < kPacket; ++i) {
          const glm::dvec3 expected = points_.active.lane[i] == 0
                                          ? glm::dvec3(0.0)
                                          : plain_irradiance(lights_, points_, i, *brute_force,
                                                             scale, static_cast<double>(bound));
          lit += expected.g > 0.0 ? 1 : 0;
          EXPECT_NEAR(static_cast<double>(irradiance.r[i]), expected.r, kRounding * expected.r);
          EXPECT_NEAR(static_cast<double>(irradiance.g[i]), expected.g, kRounding * expected.g);
          EXPECT_NEAR(static_cast<double>(irradiance.b[i]), expected.b, kRounding * expected.b);
        }
        EXPECT_EQ(lit, kPacket - 1);
      }
    }
  }
}

TEST_F(KernelTest, EveryInstructionSetGivesTheSameBits) {
  const GatherLights ready(lights_, stage_.world.coordinate_scale());
  const LightSpans spans{ready.surface.data(), ready.point.data(), ready.directional.data(),
                         ready.surface.size(), ready.point.size(), ready.directional.size()};
  std::vector<GatherKernel*> kernels = {gather_irradiance_baseline};
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) kernels.push_back(gather_irradiance_avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    kernels.push_back(gather_irradiance_avx512);
  }
#endif
  IrradiancePacket first;
  const std::uint64_t rays =
      kernels[0](spans, points_, *stage_.tracer, 0.5f, ShadowRays::kPackets, first);
  EXPECT_GT(rays, 0u);
  for (GatherKernel* kernel : kernels) {
    IrradiancePacket other;
    EXPECT_EQ(kernel(spans, points_, *stage_.tracer, 0.5f, ShadowRays::kPackets, other), rays);
    for (int i = 0; i < kPacket; ++i) {
      EXPECT_EQ(first.r[i], other.r[i]);
      EXPECT_EQ(first.g[i], other.g[i]);
      EXPECT_EQ(first.b[i], other.b[i]);
    }
  }
}

/// An empty place: one triangle far below, so that nothing throws a shadow.
Scene nowhere() {
  Scene scene;
  test::add_mesh(scene, test::add_material(scene, 0.5f, 0.0f),
                 {{0, -100, 0}, {1, -100, 0}, {0, -100, 1}}, {{0, 1, 2}});
  return scene;
}

VirtualLights one_light(LightKind kind, const Vec3& position, const Vec3& normal) {
  VirtualLights lights;
  lights.kind = {kind};
  lights.position = {position};
  lights.normal = {normal};
  lights.flux = {Rgb(1.0f)};
  lights.path = lights.bounce = {0};
  lights.cone = {kind == LightKind::kSpot ? Vec2(0.9f, 0.5f) : Vec2(0.0f)};
  return lights;
}

TEST(Kernel, NoLightPassesThroughTheGeometricSide) {
  const Stage stage(nowhere());
  const Vec3 to_light = glm::normalize(Vec3(1.0f, 0.2f, 0.0f));
  for (const LightKind kind :
       {LightKind::kSurface, LightKind::kPoint, LightKind::kSpot, LightKind::kDirectional}) {
    const GatherLights lights(one_light(kind, 2.0f * to_light, -to_light), 0.0f);
    const auto lit = [&](const Vec3& shading, const Vec3& geometric) {
      ShadingPacket packet = test::packet_of(std::array{Receiver{Vec3(0.0f), shading}});
      packet.geometric_x[0] = geometric.x;
      packet.geometric_y[0] = geometric.y;
      packet.geometric_z[0] = geometric.z;
      IrradiancePacket irradiance;
      const std::uint64_t rays = gather_irradiance(lights, packet, *stage.tracer, kInfinity,
                                                   ShadowRays::kPackets, irradiance);
      EXPECT_EQ(rays, irradiance.g[0] > 0.0f ? 1u : 0u);
      return irradiance.g[0] > 0.0f;
    };
    const Vec3 up(0, 1, 0), leaning = glm::normalize(Vec3(-1, 1, 0));
    EXPECT_TRUE(lit(up, up));
    EXPECT_TRUE(lit(up, glm::normalize(Vec3(-0.1f, 1, 0))));
    EXPECT_FALSE(lit(up, leaning)) << "the light is behind the surface";
    EXPECT_FALSE(lit(leaning, up)) << "the light is behind the shading normal";
    EXPECT_FALSE(lit(-up, -up));
  }
}

TEST(Kernel, TheBoundCutsTheGeometryTermOfSurfaceLightsAlone) {
  const Stage stage(nowhere());
  const std::array receivers = {Receiver{Vec3(0.0f), Vec3(0, 1, 0)}};
  for (const float height : {0.5f, 1.0f, 2.0f, 4.0f}) {
    const float term = 1.0f / (height * height);
    for (const float bound : {0.1f, 0.9f, 1.0f, 1.1f, 5.0f}) {
      const auto green = [&](LightKind kind, float own = 0.0f) {
        const std::array bounds = {own};
        const GatherLights lights(one_light(kind, Vec3(0, height, 0), Vec3(0, -1, 0)), 0.0f,
                                  bounds);
        IrradiancePacket irradiance;
        gather_irradiance(lights, test::packet_of(receivers), *stage.tracer, bound,
                          ShadowRays::kPackets, irradiance);
        return irradiance.g[0];
      };
      EXPECT_FLOAT_EQ(green(LightKind::kSurface), std::min(term, bound) * kInvPi);
      // A light's own bound counts where it is the higher one.
      constexpr float kOwn = 1.0f;
      EXPECT_FLOAT_EQ(green(LightKind::kSurface, kOwn),
                      std::min(term, std::max(bound, kOwn)) * kInvPi);
      EXPECT_FLOAT_EQ(green(LightKind::kPoint), term / (4.0f * kPi));
      EXPECT_FLOAT_EQ(green(LightKind::kDirectional), 1.0f);
    }
  }
}

}  // namespace
}  // namespace lantern
