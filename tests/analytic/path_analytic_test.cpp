// SPDX-License-Identifier: MIT
// The path tracer where the light is known in closed form. Means are compared within kSigmas of the
// standard errors that its own variance gives, which is unbiased over passes.
#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/path/path_tracer.h"
#include "lantern/path/variance.h"
#include "lantern/sampling/warp.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

namespace lantern {
namespace {

/// A right tracer is further off in one of 15 000 comparisons, and then always: seeds are fixed.
constexpr double kSigmas = 4.0;
/// Roundings of float along a path, and rays that start 2^-18 of the scene off its surfaces.
constexpr double kRounding = 1e-4;

struct Estimate {
  Rgb radiance{0.0f};
  Rgb standard_error{0.0f};
};

struct Settings {
  int size = 8;  // of the square picture
  int samples = 64;
  std::size_t passes = 16;
  float fov = 0.7f;
};

/// Mean over the picture that `camera` sees, and its error: pixels are independent of each other.
Estimate mean_radiance(const Scene& scene, const Camera& camera, const Settings& settings = {}) {
  const World world = make_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const LightChoice lights(scene, world);
  PathOptions options;
  options.width = options.height = settings.size;
  options.samples = settings.samples;
  options.squares = true;
  VarianceEstimate variance(settings.size, settings.size, settings.samples);
  const StopFlag never{false};
  PathCounts counts;
  glm::dvec3 sum(0.0), variances(0.0);
  for (std::size_t pass = 0; pass < settings.passes; ++pass) {
    options.pass = pass;
    const PathPass made =
        trace_paths({scene, world, *tracer, lights, camera}, options, counts, never);
    variance.add(made);
    for (const Rgb& pixel : made.radiance.pixels) sum += glm::dvec3(pixel);
  }
  const Image of_mean = variance.of_mean();
  for (const Rgb& pixel : of_mean.pixels) variances += glm::dvec3(pixel);
  const auto pixels = static_cast<double>(of_mean.pixels.size());
  return {Rgb(sum / (pixels * static_cast<double>(settings.passes))),
          Rgb(glm::sqrt(variances) / pixels)};
}

void expect_radiance(const Estimate& estimate, const glm::dvec3& expected,
                     double tolerance = kRounding) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(static_cast<double>(estimate.radiance[channel]), expected[channel],
                kSigmas * static_cast<double>(estimate.standard_error[channel]) +
                    tolerance * expected[channel])
        << "channel " << channel;
  }
}

void expect_radiance(const Estimate& estimate, double expected, double tolerance = kRounding) {
  expect_radiance(estimate, glm::dvec3(expected), tolerance);
}

/// Looks at the origin out of `eye`; the origin fills the picture.
Camera close_up(const Vec3& eye) {
  Camera camera;
  camera.eye = eye;
  camera.forward = glm::normalize(-eye);
  camera.up = Vec3(0.3f, 0.4f, 1.0f);
  camera.vertical_fov = 1e-4f;
  return camera;
}

/// A floor around the origin that faces +y and has no texture coordinates.
Mesh& add_floor(Scene& scene, float reflectance, float half = 10.0f) {
  Mesh& floor = test::add_quad(scene, test::add_material(scene, reflectance, 0.0f),
                               Vec3(-half, 0, -half), Vec3(0, 0, 2 * half), Vec3(2 * half, 0, 0));
  floor.texcoords.clear();
  return floor;
}

PunctualLight& add_light(Scene& scene, PunctualKind kind, const Rgb& intensity) {
  PunctualLight& light = scene.lights.emplace_back();
  light.kind = kind;
  light.intensity = intensity;
  return light;
}

TextureId add_texture(Scene& scene, int width, int height,
                      const std::function<Vec4(int, int)>& value) {
  Texture& texture = scene.textures.emplace_back();
  texture.width = width;
  texture.height = height;
  texture.wrap_u = texture.wrap_v = Wrap::kClamp;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec4 v = value(x, y);
      texture.linear.insert(texture.linear.end(), {v.r, v.g, v.b, v.a});
    }
  }
  return to_id<TextureId>(scene.textures.size() - 1);
}

constexpr float kReflectance = 0.6f;

// --- the furnace
// -----------------------------------------------------------------------------------------

TEST(PathFurnace, ShowsEmissionOverAbsorption) {
  constexpr float kEmission = 1.5f;
  for (const float reflectance : {0.0f, 0.3f, 0.8f, 0.95f}) {
    for (const bool sphere : {false, true}) {
      SCOPED_TRACE(testing::Message() << reflectance << (sphere ? " sphere" : " box"));
      const Scene scene = sphere ? test::sphere_room(2, reflectance, kEmission)
                                 : test::box_room(Vec3(2.0f, 2.4f, 2.2f), reflectance, kEmission);
      Camera camera;
      camera.eye = Vec3(0.1f, -0.2f, 0.3f);
      camera.vertical_fov = 2.0f;
      // In a corner a hair off both walls some rays slip between them: a part in 2^18 of its size.
      const double expected = static_cast<double>(kEmission / (1.0f - reflectance));
      const Estimate estimate = mean_radiance(scene, camera);
      expect_radiance(estimate, expected);
      // The test can fail: it knows the answer to two per cent or better.
      EXPECT_LT(estimate.standard_error.g, 0.02 * expected / kSigmas);
    }
  }
}

// --- a polygon above a floor [Lambert 1760]
// -----------------------------------------------------------------------------------------

std::vector<glm::dvec3> lamp_corners(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {glm::dvec3(corner), glm::dvec3(corner + u), glm::dvec3(corner + u + v),
          glm::dvec3(corner + v)};
}

struct Lamp {
  const char* name;
  Vec3 corner, u, v;
};

TEST(PathDirectLight, OfAPolygonIsLamberts) {
  const Lamp lamps[] = {
      {"above", Vec3(-0.5f, 1.0f, -0.4f), Vec3(1.0f, 0, 0), Vec3(0, 0, 0.9f)},
      {"close and large", Vec3(-2.0f, 0.1f, -2.0f), Vec3(4.0f, 0, 0), Vec3(0, 0, 4.0f)},
      {"standing on the horizon", Vec3(0.7f, -0.5f, -0.5f), Vec3(0, 0, 1.0f), Vec3(0, 2.0f, 0)},
      {"small and far", Vec3(3.0f, 4.0f, 1.0f), Vec3(0.02f, 0, 0), Vec3(0, 0, 0.02f)},
  };
  const glm::dvec3 radiance(7.0, 3.0, 0.5);
  for (const Lamp& lamp : lamps) {
    SCOPED_TRACE(lamp.name);
    Scene scene;
    add_floor(scene, kReflectance);
    const MaterialId material = test::add_material(scene, 0.0f, 0.0f);
    scene.materials[index(material)].emission = Rgb(radiance);
    test::add_quad(scene, material, lamp.corner, lamp.u, lamp.v);
    // From below a lamp close to the floor the camera must look past it.
    const Estimate estimate = mean_radiance(scene, close_up(Vec3(-0.03f, 0.05f, 0.0f)));
    const auto corners = lamp_corners(lamp.corner, lamp.u, lamp.v);
    const double irradiance = test::polygon_irradiance(corners, {0, 1, 0}, 1.0);
    expect_radiance(estimate, radiance * irradiance * (0.6 / std::numbers::pi));
    EXPECT_LT(estimate.standard_error.g, 0.01 * static_cast<double>(estimate.radiance.g));
  }
}

TEST(PathDirectLight, LeavesTheFrontAloneUnlessDoubleSided) {
  for (const bool double_sided : {false, true}) {
    Scene scene;
    add_floor(scene, kReflectance);
    const MaterialId material = test::add_material(scene, 0.0f, 2.0f);
    scene.materials[index(material)].double_sided = double_sided;
    const Vec3 corner(-0.5f, 1.0f, -0.5f), u(1, 0, 0), v(0, 0, 1);
    test::add_quad(scene, material, corner, v, u);  // its back looks down
    const double irradiance = test::polygon_irradiance(lamp_corners(corner, u, v), {0, 1, 0}, 2.0);
    const Estimate estimate = mean_radiance(scene, close_up(Vec3(0.1f, 0.5f, 0.0f)));
    expect_radiance(estimate, double_sided ? irradiance * 0.6 / std::numbers::pi : 0.0);
  }
}

TEST(PathDirectLight, OfATexturedLampIsThatOfItsBrightPart) {
  Scene scene;
  add_floor(scene, kReflectance);
  // Bright where u > 1/2. The filter blends over one texel, evenly to both sides of the border.
  constexpr int kTexels = 256;
  const TextureId texture = add_texture(scene, kTexels, 1, [](int x, int) {
    return Vec4(Vec3(x < kTexels / 2 ? 0.0f : 1.0f), 1.0f);
  });
  const MaterialId material = test::add_material(scene, 0.0f, 3.0f);
  scene.materials[index(material)].emission_texture = texture;
  const Vec3 corner(-0.5f, 1.0f, -0.4f), u(1.0f, 0, 0), v(0, 0, 0.9f);
  test::add_quad(scene, material, corner, u, v);
  const double irradiance =
      test::polygon_irradiance(lamp_corners(corner + 0.5f * u, 0.5f * u, v), {0, 1, 0}, 3.0);
  expect_radiance(mean_radiance(scene, close_up(Vec3(0.1f, 0.5f, 0.0f))),
                  irradiance * 0.6 / std::numbers::pi);
}

/// A lamp that stops a quarter of the rays sends a quarter of the light; so does a sheet before it.
TEST(PathDirectLight, PassesBlendedSurfacesInProportion) {
  for (const bool lamp_blended : {false, true}) {
    SCOPED_TRACE(lamp_blended);
    Scene scene;
    add_floor(scene, kReflectance);
    const MaterialId lamp = test::add_material(scene, 0.0f, 2.0f);
    const MaterialId sheet = test::add_material(scene, 0.0f, 0.0f);
    Material& blended = scene.materials[index(lamp_blended ? lamp : sheet)];
    blended.blend = true;
    blended.opacity = 0.25f;
    const Vec3 corner(-0.5f, 1.0f, -0.4f), u(1.0f, 0, 0), v(0, 0, 0.9f);
    test::add_quad(scene, lamp, corner, u, v);
    if (!lamp_blended)
      test::add_quad(scene, sheet, Vec3(-5, 0.8f, -5), Vec3(10, 0, 0), Vec3(0, 0, 10));
    const double whole = test::polygon_irradiance(lamp_corners(corner, u, v), {0, 1, 0}, 2.0);
    expect_radiance(mean_radiance(scene, close_up(Vec3(0.1f, 0.5f, 0.0f))),
                    (lamp_blended ? 0.25 : 0.75) * whole * 0.6 / std::numbers::pi);
  }
}

TEST(PathDirectLight, PassesTheHolesOfAMask) {
  Scene scene;
  add_floor(scene, kReflectance);
  // Opaque where u < 1/2, over the side of the lamp with x < 0.
  const TextureId texture =
      add_texture(scene, 2, 1, [](int x, int) { return Vec4(Vec3(1.0f), x == 0 ? 1.0f : 0.0f); });
  const MaterialId mask = test::add_material(scene, 0.0f, 0.0f);
  scene.materials[index(mask)].reflectance_texture = texture;
  scene.materials[index(mask)].alpha_cutoff = 0.5f;
  const Vec3 corner(-0.5f, 1.0f, -0.4f), u(1.0f, 0, 0), v(0, 0, 0.9f);
  test::add_quad(scene, test::add_material(scene, 0.0f, 2.0f), corner, u, v);
  test::add_quad(scene, mask, corner - Vec3(0, 1e-3f, 0), u, v);
  const double irradiance =
      test::polygon_irradiance(lamp_corners(corner + 0.5f * u, 0.5f * u, v), {0, 1, 0}, 2.0);
  // The millimetre between mask and lamp moves the border by as much as a thousandth of the lamp.
  expect_radiance(mean_radiance(scene, close_up(Vec3(0.1f, 0.5f, 0.0f))),
                  irradiance * 0.6 / std::numbers::pi, 2e-3);
}

// --- lights without area
// -----------------------------------------------------------------------------------------
// The only choice there is has no variance: what is left is rounding.

TEST(PathDirectLight, OfTheSunIsItsIrradianceTimesTheCosine) {
  Scene scene;
  add_floor(scene, kReflectance);
  PunctualLight& sun = add_light(scene, PunctualKind::kDirectional, Rgb(3.0f, 2.0f, 1.0f));
  sun.direction = glm::normalize(Vec3(1.0f, -2.0f, 0.5f));
  const double cosine = -static_cast<double>(sun.direction.y);
  expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))),
                  glm::dvec3(3, 2, 1) * cosine * 0.6 / std::numbers::pi);
}

TEST(PathDirectLight, OfAPointIsItsIntensityOverTheSquaredDistance) {
  Scene scene;
  add_floor(scene, kReflectance);
  add_light(scene, PunctualKind::kPoint, Rgb(3.0f, 2.0f, 1.0f)).position = Vec3(0.6f, 0.8f, 0.0f);
  expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))),
                  glm::dvec3(3, 2, 1) * 0.8 * 0.6 / std::numbers::pi);
}

TEST(PathDirectLight, OfASpotFallsOffBetweenItsCones) {
  for (const float angle : {0.0f, 0.2f, 0.35f, 0.45f, 0.6f}) {
    SCOPED_TRACE(angle);
    Scene scene;
    add_floor(scene, kReflectance);
    PunctualLight& spot = add_light(scene, PunctualKind::kSpot, Rgb(4.0f));
    spot.position = Vec3(0.0f, 2.0f, 0.0f);
    spot.direction = Vec3(std::sin(angle), -std::cos(angle), 0.0f);
    spot.inner_angle = 0.25f;
    spot.outer_angle = 0.5f;
    const double ramp = std::clamp(
        (std::cos(static_cast<double>(angle)) - std::cos(0.5)) / (std::cos(0.25) - std::cos(0.5)),
        0.0, 1.0);
    expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))),
                    4.0 * ramp * ramp / 4.0 * 0.6 / std::numbers::pi);
  }
}

TEST(PathDirectLight, IsSharedFairlyAmongManyEmitters) {
  Scene scene;
  add_floor(scene, kReflectance);
  add_light(scene, PunctualKind::kPoint, Rgb(0.5f)).position = Vec3(0, 0.5f, 0);
  add_light(scene, PunctualKind::kDirectional, Rgb(1.0f)).direction = Vec3(0, -1, 0);
  const Vec3 corner(-0.5f, 1.0f, -0.4f), u(1.0f, 0, 0), v(0, 0, 0.9f);
  test::add_quad(scene, test::add_material(scene, 0.0f, 2.0f), corner + Vec3(2, 0, 0), u, v);
  const double lamp =
      test::polygon_irradiance(lamp_corners(corner + Vec3(2, 0, 0), u, v), {0, 1, 0}, 2.0);
  expect_radiance(mean_radiance(scene, close_up(Vec3(0.1f, 0.3f, 0))),
                  (lamp + 0.5 / 0.25 + 1.0) * 0.6 / std::numbers::pi);
}

// --- the sky
// -----------------------------------------------------------------------------------------

TEST(PathSky, LightsAnOpenFloorAndIsSeen) {
  for (const bool textured : {false, true}) {
    SCOPED_TRACE(textured);
    Scene scene;
    add_floor(scene, kReflectance);
    Sky& sky = scene.sky.emplace();
    sky.radiance = Rgb(3.0f, 2.0f, 1.0f);
    if (textured) sky.texture = add_texture(scene, 8, 4, [](int, int) { return Vec4(0.5f); });
    const double share = textured ? 0.5 : 1.0;
    expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))),
                    glm::dvec3(3, 2, 1) * share * 0.6);
    Camera up = close_up(Vec3(0, 1, 0));
    up.forward = Vec3(0, 1, 0);
    expect_radiance(mean_radiance(scene, up), glm::dvec3(3, 2, 1) * share);
  }
}

/// Irradiance of a floor under any sky: the sum over a fine lat-long grid in double precision.
double sky_irradiance(const Scene& scene) {
  const Texture& texture = scene.textures[index(*scene.sky->texture)];
  constexpr int kRows = 1024, kColumns = 2048;
  double sum = 0.0;
  for (int y = 0; y < kRows / 2; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const double v = (y + 0.5) / kRows, u = (x + 0.5) / kColumns, polar = std::numbers::pi * v;
      const double solid_angle = std::sin(polar) * 2.0 * std::numbers::pi * std::numbers::pi /
                                 (static_cast<double>(kRows) * kColumns);
      sum += static_cast<double>(sample(texture, Vec2(u, v)).g) * std::cos(polar) * solid_angle;
    }
  }
  return sum;
}

TEST(PathSky, OfAPictureWithASmallSunIsItsIntegral) {
  Scene scene;
  add_floor(scene, kReflectance);
  scene.sky.emplace().radiance = Rgb(1.0f);
  scene.sky->texture = add_texture(scene, 64, 32, [](int x, int y) {
    return Vec4(x == 20 && y == 6 ? 500.0f : 0.1f + 0.01f * static_cast<float>(y));
  });
  scene.textures.back().wrap_u = Wrap::kRepeat;
  const Estimate estimate = mean_radiance(scene, close_up(Vec3(0, 1, 0)));
  // The grid of the sum has 32 x 32 points a texel.
  expect_radiance(estimate, sky_irradiance(scene) * 0.6 / std::numbers::pi, 1e-3);
  EXPECT_LT(estimate.standard_error.g, 0.01f * estimate.radiance.g);
}

// --- shading normals
// -----------------------------------------------------------------------------------------

TEST(PathShading, NormalEntersTheCosineWhereTheEyeSeesIt) {
  for (const float tilt : {0.0f, 0.5f, 1.2f}) {
    SCOPED_TRACE(tilt);
    Scene scene;
    Mesh& floor = add_floor(scene, kReflectance);
    floor.normals.assign(floor.positions.size(), Vec3(std::sin(tilt), std::cos(tilt), 0.0f));
    add_light(scene, PunctualKind::kDirectional, Rgb(1.0f)).direction = Vec3(0, -1, 0);
    expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))),
                    std::cos(static_cast<double>(tilt)) * 0.6 / std::numbers::pi);
  }
}

TEST(PathShading, NoNormalLetsLightThroughTheGeometricSide) {
  Scene scene;
  Mesh& floor = add_floor(scene, kReflectance);
  floor.normals.assign(floor.positions.size(), glm::normalize(Vec3(3.0f, 1.0f, 0.0f)));
  // From below the floor's plane, towards the tilted normal.
  add_light(scene, PunctualKind::kDirectional, Rgb(1.0f)).direction =
      glm::normalize(Vec3(-1.0f, 0.1f, 0.0f));
  scene.sky.emplace().radiance = Rgb(1.0f);
  // Of the sky the part of the tilted hemisphere counts that lies above: 1/2 (1 + cos of the tilt)
  // of a cosine-weighted hemisphere.
  const double expected = 0.6 * 0.5 * (1.0 + 1.0 / std::sqrt(10.0));
  expect_radiance(mean_radiance(scene, close_up(Vec3(0, 1, 0))), expected);
}

// --- against brute force
// -----------------------------------------------------------------------------------------

/// The rendering equation with nothing clever: cosine-distributed rays until one hits an emitter,
/// each weighted with its reflectances; the sum over all vertices of what they emit.
Rgb naive_radiance(const Scene& scene, const World& world, const Tracer& tracer, Ray ray,
                   std::uint64_t& state) {
  Rgb radiance(0.0f), throughput(1.0f);
  const auto random = [&state] { return to_unit_float(hash(++state)); };
  for (int bounce = 0; bounce < 64; ++bounce) {
    const Hit hit = tracer.closest(ray);
    if (!hit) {
      return scene.sky ? radiance + throughput * scene.sky->radiance : radiance;
    }
    const SurfacePoint surface = surface_at(scene, world, hit.triangle, hit.uv);
    const bool front = glm::dot(surface.geometric_normal, ray.direction) < 0.0f;
    radiance += throughput * emission_at(scene, world, hit.triangle, hit.uv, front);
    throughput *= surface.reflectance;
    if (random() >= 0.7f) return radiance;
    throughput /= 0.7f;
    const Vec3 normal = front ? surface.geometric_normal : -surface.geometric_normal;
    ray.origin = off_surface(surface.position, normal, world.coordinate_scale());
    const float u = random();
    ray.direction = Frame(normal).to_world(square_to_cosine_hemisphere({u, random()}));
  }
  return radiance;
}

/// Coloured walls, a wide lamp and a box that hides it from some of them, open to a sky at one end.
Scene half_open_room() {
  Scene scene = test::box_room(Vec3(2.0f), 0.5f, 0.0f);
  scene.instances.pop_back();
  scene.materials[0].reflectance = Rgb(0.8f, 0.5f, 0.2f);
  test::add_quad(scene, test::add_material(scene, 0.3f, 2.0f), Vec3(-0.6f, 0.9f, -0.6f),
                 Vec3(1.2f, 0, 0), Vec3(0, 0, 1.2f));
  test::add_quad(scene, test::add_material(scene, 0.7f, 0.0f), Vec3(-0.5f, -0.3f, -0.5f),
                 Vec3(0, 0, 0.9f), Vec3(0.8f, 0.2f, 0));
  scene.sky.emplace().radiance = Rgb(0.3f, 0.5f, 1.0f);
  return scene;
}

TEST(PathTracer, AgreesWithBruteForce) {
  const Scene scene = half_open_room();
  const World world = make_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  for (const Vec3& target :
       {Vec3(-0.3f, -1.0f, 0.1f), Vec3(1.0f, 0.3f, 0.2f), Vec3(0.2f, 1.0f, 0.8f)}) {
    Camera camera = close_up(Vec3(0.1f, 0.2f, 0.7f) - target);
    camera.eye += target;
    constexpr int kPaths = 400'000;
    glm::dvec3 sum(0.0), squares(0.0);
    std::uint64_t state = 0;
    for (int i = 0; i < kPaths; ++i) {
      Ray ray;
      ray.origin = camera.eye;
      ray.direction = camera.forward;
      const glm::dvec3 r(naive_radiance(scene, world, *tracer, ray, state));
      sum += r;
      squares += r * r;
    }
    const glm::dvec3 mean = sum / double{kPaths};
    const glm::dvec3 naive_error =
        glm::sqrt((squares / double{kPaths} - mean * mean) / double{kPaths});
    Estimate estimate = mean_radiance(scene, camera);
    estimate.standard_error = Rgb(glm::sqrt(
        naive_error * naive_error + glm::dvec3(estimate.standard_error * estimate.standard_error)));
    expect_radiance(estimate, mean);
    EXPECT_LT(estimate.standard_error.g, 0.01f * estimate.radiance.g);
  }
}

// --- what it says about itself
// -----------------------------------------------------------------------------------------

PathPass room_pass(int threads) {
  const Scene scene = half_open_room();
  const World world = make_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const LightChoice lights(scene, world);
  Camera camera;
  camera.eye = Vec3(0.0f, 0.1f, 0.9f);
  camera.vertical_fov = 1.2f;
  PathOptions options;
  options.width = 70;  // no multiple of a tile or of a packet
  options.height = 45;
  options.samples = 4;
  options.squares = true;
  PathCounts counts;
  const StopFlag never{false};
  PathPass pass;
  ThreadScope scope(threads);
  scope.run([&] {
    pass = trace_paths({scene, world, *tracer, lights, camera}, options, counts, never);
  });
  return pass;
}

TEST(PathTracer, GivesTheSameBitsOnAnyNumberOfThreads) {
  const PathPass one = room_pass(1);
  for (const int threads : {2, 7}) {
    const PathPass more = room_pass(threads);
    EXPECT_EQ(more.radiance.pixels, one.radiance.pixels) << threads;
    EXPECT_EQ(more.squared_radiance.pixels, one.squared_radiance.pixels) << threads;
  }
}

TEST(PathTracer, StopsWhenAskedTo) {
  const Scene scene = half_open_room();
  const World world = make_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const LightChoice lights(scene, world);
  const Camera camera = close_up(Vec3(0, 0.1f, 0.5f));
  PathCounts counts;
  const StopFlag stopped{true};
  const PathPass pass = trace_paths({scene, world, *tracer, lights, camera}, {}, counts, stopped);
  EXPECT_EQ(counts.camera_rays, 0u);
  EXPECT_TRUE(is_black(pass.radiance.at(5, 5)));
}

/// Repeated with other seeds, the picture scatters as the variance says: over pixels the mean ratio
/// of squared deviation to variance is near one. With passes it is unbiased; of the samples of one
/// pass it is an upper bound on average.
TEST(PathVariance, IsThatOfRepeatedPictures) {
  const Scene scene = half_open_room();
  const World world = make_world(scene);
  const std::unique_ptr<Tracer> tracer = make_embree_tracer(scene, world);
  const LightChoice lights(scene, world);
  Camera camera;
  camera.eye = Vec3(0.0f, 0.1f, 0.9f);
  camera.vertical_fov = 1.2f;
  PathOptions options;
  options.width = options.height = 32;
  options.squares = true;
  const StopFlag never{false};
  for (const std::size_t passes : {1, 8}) {
    SCOPED_TRACE(passes);
    options.samples = passes == 1 ? 16 : 4;
    constexpr std::size_t kRuns = 24;
    double claimed = 0.0;
    std::vector<glm::dvec3> sum(1024), squares(1024);
    for (std::size_t run = 0; run < kRuns; ++run) {
      options.seed = run;
      VarianceEstimate variance(32, 32, options.samples);
      std::vector<glm::dvec3> mean(1024);
      for (options.pass = 0; options.pass < passes; ++options.pass) {
        PathCounts counts;
        const PathPass pass =
            trace_paths({scene, world, *tracer, lights, camera}, options, counts, never);
        variance.add(pass);
        for (std::size_t i = 0; i < 1024; ++i) {
          mean[i] += glm::dvec3(pass.radiance.pixels[i]) / static_cast<double>(passes);
        }
      }
      const Image claims = variance.of_mean();
      for (std::size_t i = 0; i < 1024; ++i) {
        claimed += static_cast<double>(claims.pixels[i].g) / kRuns;
        sum[i] += mean[i];
        squares[i] += mean[i] * mean[i];
      }
    }
    double found = 0.0;
    for (std::size_t i = 0; i < 1024; ++i) {
      found += (squares[i].g - sum[i].g * sum[i].g / kRuns) / (kRuns - 1);
    }
    // Both sums err by a few per cent: 1024 pixels with 23 degrees of freedom each scatter by
    // sqrt(2 / 23 / 1024) = 1 % were they alike, but a tenth of them has most of the variance.
    if (passes == 1) {
      EXPECT_GT(claimed, 0.95 * found);
      EXPECT_LT(claimed, 6.0 * found);
    } else {
      EXPECT_NEAR(claimed / found, 1.0, 0.1);
    }
  }
}

TEST(PathVariance, IsDefinedForAFewSamples) {
  const auto pass_of = [](float mean, float square) {
    return PathPass{Image(1, 1, Rgb(mean)), Image(1, 1, Rgb(square))};
  };
  // One sample of 3: nothing is known but its own size.
  VarianceEstimate one(1, 1, 1);
  EXPECT_TRUE(is_black(one.of_mean().at(0, 0)));
  one.add(pass_of(3.0f, 9.0f));
  EXPECT_FLOAT_EQ(one.of_mean().at(0, 0).g, 9.0f);
  // Two of 1 and 3: s² = 2, of the mean 1.
  VarianceEstimate two(1, 1, 2);
  two.add(pass_of(2.0f, 5.0f));
  EXPECT_FLOAT_EQ(two.of_mean().at(0, 0).g, 1.0f);
  // The same as two passes of one each.
  VarianceEstimate apart(1, 1, 1);
  apart.add(pass_of(1.0f, 1.0f));
  apart.add(pass_of(3.0f, 9.0f));
  EXPECT_FLOAT_EQ(apart.of_mean().at(0, 0).g, 1.0f);
  // Eight passes of means 1 and 3 in turn: s² = 8/7, of the mean 1/7, whatever their samples.
  VarianceEstimate eight(1, 1, 4);
  for (int i = 0; i < 8; ++i) {
    const float mean = i % 2 == 0 ? 1.0f : 3.0f;
    eight.add(pass_of(mean, 100.0f));
  }
  EXPECT_FLOAT_EQ(eight.of_mean().at(0, 0).g, 1.0f / 7.0f);
}

}  // namespace
}  // namespace lantern
