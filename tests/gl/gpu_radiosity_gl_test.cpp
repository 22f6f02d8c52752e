// SPDX-License-Identifier: MIT
// Radiosity on the GPU: its parts against rays, its light against closed forms and the matrix.
#include "lantern/core/parallel.h"
#include "lantern/gl/context.h"
#include "lantern/image/compare.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/render.h"
#include "lantern/radiosity/display.h"
#include "lantern/radiosity/element_points.h"
#include "lantern/radiosity/external_light.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/hemicube.h"
#include "lantern/radiosity/hemicube_rows.h"
#include "lantern/radiosity/solve.h"
#include "lantern/radiosity_gl/gpu_radiosity.h"
#include "lantern/radiosity_gl/item_buffer.h"
#include "lantern/radiosity_gl/item_painter.h"
#include "lantern/radiosity_gl/occluder_textures.h"
#include "lantern/radiosity_gl/shooter_tree.h"

#include "tests/analytic/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <numbers>

namespace lantern {
namespace {

constexpr double kPi64 = std::numbers::pi;

struct Patched {
  test::Stage stage;
  Patches patches;
  std::vector<glm::dvec3> external;

  Patched(Scene scene, std::size_t count)
      : stage(std::move(scene)),
        patches(make_patches(stage.scene, stage.world, *stage.tracer, {.count = count})),
        external(external_irradiance(stage.scene, stage.world, *stage.tracer, patches, {false})) {}

  GpuRadiosity radiosity(const GpuRadiosityOptions& options) const {
    return {stage.world, *stage.tracer, patches, external, options};
  }
};

/// A room of two colours with a lamp below its ceiling and a box `lift` above its floor; `open`
/// leaves one wall out.
Scene furnished_room(bool open, float lift = 0.0f) {
  Scene scene;
  const MaterialId white = test::add_material(scene, 0.7f, 0.0f);
  const MaterialId red = test::add_material(scene, 0.0f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.1f, 5.0f);
  scene.materials[index(red)].reflectance = Rgb(0.6f, 0.1f, 0.05f);
  const Vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  test::add_quad(scene, white, Vec3(0), z, x);
  test::add_quad(scene, white, y, x, z);
  test::add_quad(scene, red, Vec3(0), y, z);
  test::add_quad(scene, white, x, z, y);
  test::add_quad(scene, white, Vec3(0), x, y);
  if (!open) test::add_quad(scene, white, z, y, x);
  test::add_quad(scene, lamp, {0.6f, 1.95f, 0.6f}, {0.6f, 0, 0}, {0, 0, 0.6f});
  const Vec3 low(1.1f, lift, 0.3f), a(0.5f, 0, 0.1f), b(-0.1f, 0, 0.5f), up(0, 0.8f, 0);
  test::add_quad(scene, white, low + up, b, a);
  test::add_quad(scene, white, low, a, b);
  test::add_quad(scene, white, low, up, a);
  test::add_quad(scene, white, low, b, up);
  test::add_quad(scene, white, low + b, a, up);
  test::add_quad(scene, white, low + a, up, b);
  return scene;
}

GpuRadiosityOptions quick() { return {.hemicube = 64, .cutoff = 2e-3, .limits = {}, .seed = 0}; }

// --- the hierarchy
// --------------------------------------------------------------------------------

TEST(ShooterTree, ClustersArePlanarWithinTheirLimitsAndMeetEachTexelOnce) {
  const Patched room(furnished_room(false), 800);
  const Patches& patches = room.patches;
  const ShooterTree tree(patches);
  const double radius = static_cast<double>(room.stage.world.bounds.radius());
  // All the same flux: nothing is left for later.
  const std::vector<double> flux(patches.elements(), 1.0);
  const auto emitted = static_cast<double>(patches.elements());
  const ShotLimits limits;
  std::vector<int> met(patches.elements(), 0);
  double last = emitted;
  for (const Cluster& cluster :
       tree.choose(flux, emitted, radius, {.share = 1.0 / 64.0, .spread = 1.0, .count = 16})) {
    EXPECT_LE(cluster.count, 16u);
    EXPECT_LE(cluster.count, last);
    last = cluster.count;
    const std::uint32_t first = tree.element_of_texel()[cluster.first];
    double area = 0.0;
    for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const std::uint32_t e = tree.element_of_texel()[i];
      ++met[e];
      area += patches.exposed_area(e);
      EXPECT_EQ(patches.is_front(e), patches.is_front(first));
      EXPECT_EQ(patches.mesh.faces[patches.patch[e]].source,
                patches.mesh.faces[patches.patch[first]].source);
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(glm::length(patches.mesh.corner(patches.patch[e], k) - cluster.centre),
                  cluster.radius * (1.0 + 1e-9));
      }
    }
    EXPECT_NEAR(cluster.area, area, 1e-12);
  }
  EXPECT_THAT(met, testing::Each(1));
  for (const Cluster& cluster : tree.choose(flux, emitted, radius, limits)) {
    const double share = cluster.count / emitted, size = cluster.radius / radius;
    EXPECT_TRUE(cluster.count == 1 || share * size * size <= limits.spread);
  }
}

// --- the item buffer
// ------------------------------------------------------------------------------

TEST(ItemBuffer, SeesWhatRaysSee) {
  const gl::Context context({.api = gl::Api::kDesktop, .device = {}});
  const Vec3 in_the_open(0.6f, 0.3f, 1.2f), in_the_box(1.3f, 0.3f, 0.6f);
  for (const Vec3& origin : {in_the_open, in_the_box}) {
    const test::Stage stage(furnished_room(true));
    const gl::ShaderFiles files;
    constexpr int kSize = 64;
    ItemBuffer buffer(stage.world, std::vector<bool>(stage.world.size(), false), kSize, files);
    const Vec3 normal = glm::normalize(Vec3(0.3f, 0.5f, -0.2f));
    const Frame frame(normal);
    const HemicubePose pose{origin,
                            glm::transpose(Mat3(frame.tangent, frame.bitangent, frame.normal))};
    buffer.draw(pose);
    const std::vector<std::uint32_t> items =
        gl::Framebuffer({&buffer.items()}).read<std::uint32_t>();
    const std::vector<float> sums = gl::Framebuffer({&buffer.lost()}).read<float>();

    const Hemicube cube(kSize);
    int differ = 0, backs = 0;
    double lost = 0.0;
    for (std::size_t i = 0; i < cube.size(); ++i) {
      const Vec3 d = cube.direction(i);
      // The layout of shaders/hemicube.glsl, whose own test is against the same hemicube.
      const auto cell = [](float u) { return static_cast<std::size_t>((u + 1.0f) * 0.5f * kSize); };
      std::size_t x = 0, y = 0;
      if (d.z == 1.0f) {
        x = cell(d.x);
        y = cell(d.y);
      } else {
        const bool along_x = std::abs(d.x) == 1.0f;
        const std::size_t face = (along_x ? 0u : 2u) + ((along_x ? d.x : d.y) > 0.0f ? 0u : 1u);
        x = cell(along_x ? d.y : d.x);
        y = kSize + face * kSize / 2 + static_cast<std::size_t>(d.z * kSize / 2);
      }
      const Vec3 direction = frame.to_world(d);
      const Hit hit = stage.tracer->closest({.origin = pose.origin, .direction = direction});
      const bool back = hit && glm::dot(stage.world.area_vector(hit.triangle), direction) > 0.0f;
      const std::uint32_t expected = !hit ? 0 : hit.triangle + 1 + (back ? 0x80000000u : 0u);
      differ += items[y * kSize + x] != expected;
      backs += back;
      if (!hit || back) lost += cube.delta()[i];
    }
    // Edges that pass through the middle of a pixel to the rounding of float.
    EXPECT_LE(differ, static_cast<int>(cube.size()) / 1000);
    EXPECT_EQ(backs > 0, origin == in_the_box);
    EXPECT_NEAR(static_cast<double>(sums[1] / sums[0]), lost, 1e-3);
    EXPECT_GT(lost, 0.05);
  }
}

/// Of the delta form factors of one row against another, in total.
double difference(const FormFactorRow& a, const FormFactorRow& b, std::size_t elements) {
  std::vector<double> values(elements, 0.0);
  for (std::size_t k = 0; k < a.elements.size(); ++k) values[a.elements[k]] += a.factors[k];
  for (std::size_t k = 0; k < b.elements.size(); ++k) values[b.elements[k]] -= b.factors[k];
  double sum = std::abs(a.escaped - b.escaped);
  for (const double value : values) sum += std::abs(value);
  return sum;
}

TEST(ItemPainter, GivesTheRowsThatRaysGiveButForPixelsOnEdges) {
  const gl::Context context;
  for (const bool open : {false, true}) {
    const Patched room(furnished_room(open), 200);
    const std::size_t n = room.patches.elements();
    constexpr int kSize = 64;
    ItemPainter painter(room.stage.world, kSize);
    const auto rows = [&](HemicubePainter* with) {
      HemicubeRows hemicubes(room.stage.world, *room.stage.tracer, room.patches,
                             {.resolution = kSize, .seed = 0, .painter = with});
      std::vector<FormFactorRow> result(n);
      hemicubes.from_centres(0, result);
      return result;
    };
    const std::vector<FormFactorRow> by_rays = rows(nullptr), by_gl = rows(&painter);
    double mean = 0.0, most = 0.0;
    for (std::size_t e = 0; e < n; ++e) {
      const double here = difference(by_rays[e], by_gl[e], n);
      mean += here / static_cast<double>(n);
      most = std::max(most, here);
    }
    // Edges of triangles and patches that pass the middle of a pixel to the rounding of float:
    // 1.3e-4 and 4.6e-3 of the sum of a row were seen.
    EXPECT_LT(mean, 4e-4);
    EXPECT_LT(most, 1.5e-2);
  }
}

TEST(ItemPainter, SolvesWhatRaysSolve) {
  const Scene scene = furnished_room(true);
  RenderOptions options;
  options.camera.eye = Vec3(1.0f, 1.0f, 4.5f);
  options.camera.target = Vec3(1.0f, 1.0f, 0.0f);
  options.width = options.height = 32;
  options.method = Method::kRadiosityHemicube;
  options.radiosity.patches.count = 200;
  options.radiosity.hemicube.resolution = 32;
  const StopFlag stop{false};
  const Image by_rays = render(scene, options, stop).image;
  options.backend = Backend::kGl;
  const Image by_gl = render(scene, options, stop).image;
  const double relmse = compare(by_gl, by_rays).relmse;
  EXPECT_GT(relmse, 0.0);  // else both are one
  // A thousandth of each row seen otherwise, some of it the lamp: 4.6e-5.
  EXPECT_LT(relmse, 2e-4);
}

// --- the light
// ------------------------------------------------------------------------------------

TEST(GpuRadiosity, OfAFurnaceIsItsEmissionOverOneMinusTheReflectance) {
  const gl::Context context;
  for (const float reflectance : {0.3f, 0.8f}) {
    const Patched room(test::box_room({2.0f, 1.5f, 2.5f}, reflectance, 1.0f), 150);
    GpuRadiosity radiosity = room.radiosity(quick());
    while (radiosity.shoot()) {
    }
    const std::vector<glm::dvec3> irradiance = radiosity.irradiance();
    const double expected = kPi64 / (1.0 - static_cast<double>(reflectance));
    double mean = 0.0, area = 0.0, square = 0.0;
    for (std::size_t e = 0; e < room.patches.elements(); ++e) {
      mean += room.patches.exposed_area(e) * irradiance[e].g;
      square += room.patches.exposed_area(e) * irradiance[e].g * irradiance[e].g;
      area += room.patches.exposed_area(e);
    }
    mean /= area;
    // No flux is lost in a closed room but what slips through seams of the hemicube and what the
    // cutoff leaves unshot, which reflections would make 1/(1-a) of.
    const double left = radiosity.unshot_share() / (1.0 - static_cast<double>(reflectance));
    EXPECT_LE(radiosity.unshot_share(), quick().cutoff);
    EXPECT_LE(mean, expected * (1.0 + 1e-4));
    EXPECT_GE(mean, expected * (1.0 - left - 2e-3));
    // Each element's irradiance errs by its own form factors, of points for areas.
    EXPECT_LT(std::sqrt(square / area - mean * mean), 0.04 * mean);
  }
}

TEST(GpuRadiosity, KeepsAllFluxAndLeavesLessAndLessUnshot) {
  const gl::Context context;
  for (const bool open : {false, true}) {
    Scene scene = furnished_room(open);
    PunctualLight light;
    light.position = Vec3(0.4f, 1.2f, 1.5f);
    scene.lights.push_back(light);
    const Patched room(std::move(scene), 300);
    GpuRadiosity radiosity = room.radiosity(quick());
    double last = radiosity.unshot_share();
    std::size_t falls = 0;
    bool more = true;
    while (more) {
      more = radiosity.shoot();
      const double unshot = radiosity.unshot_share();
      EXPECT_LE(unshot, last);
      falls += unshot < last;
      last = unshot;
      const GpuFluxBalance balance = radiosity.balance();
      for (int c = 0; c < 3; ++c) {
        // Between the ends of rounds everything is as it was. A shot's flux arrives to a few
        // roundings of float.
        EXPECT_NEAR(
            (balance.absorbed[c] + balance.lost[c] + balance.unshot[c]) / balance.emitted[c], 1.0,
            1e-6);
      }
    }
    EXPECT_GT(falls, 4u);
    EXPECT_LE(last, quick().cutoff);
    const double lost = radiosity.balance().lost.g / radiosity.balance().emitted.g;
    if (open) {
      EXPECT_GT(lost, 0.1);
    } else {
      EXPECT_LT(lost, 0.01);
    }
  }
}

TEST(GpuRadiosity, IsTheSameEveryTimeAndInEveryGl) {
  const Patched room(furnished_room(true), 200);
  const auto solve = [&](std::optional<gl::Api> api) {
    const gl::Context context({.api = api, .device = {}});
    GpuRadiosity radiosity =
        room.radiosity({.hemicube = 32, .cutoff = 0.05, .limits = {}, .seed = 0});
    while (radiosity.shoot()) {
    }
    return radiosity.irradiance();
  };
  const std::vector<glm::dvec3> once = solve(gl::Api::kDesktop), again = solve(gl::Api::kDesktop);
  EXPECT_EQ(std::memcmp(once.data(), again.data(), once.size() * sizeof(glm::dvec3)), 0);
  const std::vector<glm::dvec3> es = solve(gl::Api::kEs);
  for (std::size_t e = 0; e < once.size(); ++e) {
    EXPECT_NEAR(es[e].g, once[e].g, 1e-3 * once[e].g + 1e-6);
  }
}

TEST(GpuRadiosity, AgreesWithTheMatrixOnEverySurface) {
  const gl::Context context;
  const Patched room(furnished_room(false, 0.3f), 700);
  const Patches& patches = room.patches;
  GpuRadiosity radiosity =
      room.radiosity({.hemicube = 128, .cutoff = 1e-3, .limits = {}, .seed = 0});
  while (radiosity.shoot()) {
  }
  const std::vector<glm::dvec3> gpu = radiosity.irradiance();
  const StopFlag stop{false};
  const FormFactors factors(room.stage.world, *room.stage.tracer, patches, stop);
  const std::vector<glm::dvec3> matrix =
      solve_by_gauss_seidel(patches, factors, room.external, {}, stop).irradiance;
  struct Sum {
    double area = 0.0;
    glm::dvec3 gpu{0.0}, matrix{0.0};
  };
  std::map<std::uint32_t, Sum> surfaces;  // quads are two triangles each
  for (std::size_t e = 0; e < patches.elements(); ++e) {
    if (!patches.is_front(e) || patches.exposed[e] == 0.0) continue;
    Sum& sum = surfaces[patches.mesh.faces[patches.patch[e]].source / 2];
    sum.area += patches.exposed_area(e);
    sum.gpu += patches.exposed_area(e) * gpu[e];
    sum.matrix += patches.exposed_area(e) * matrix[e];
  }
  for (const auto& [quad, sum] : surfaces) {
    // The walls' means to a hundredth. A side of the box has some twenty elements across which
    // shadows end; there the means of few points that this takes and the matrix's differ by some
    // hundredths (with twice the patches by less than two).
    constexpr double kWall = 2.0;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum.gpu[c] / sum.matrix[c], 1.0, sum.area > kWall ? 0.01 : 0.06)
          << "quad " << quad << ", channel " << c;
    }
  }
}

TEST(GpuRadiosity, AThinWallBetweenPixelsStopsLight) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "too slow with sanitizers";
#endif
  // Hemicubes of 32 pixels see little of the jambs of the door, which are 0.1 m wide.
  const gl::Context context;
  const std::filesystem::path scenes = std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes";
  const Patched rooms(load_scene(scenes / "two_rooms.scene").scene, 200);
  const Patches& patches = rooms.patches;
  const auto in_the_dark = [&](int hemicube) {
    GpuRadiosity radiosity =
        rooms.radiosity({.hemicube = hemicube, .cutoff = 5e-2, .limits = {}, .seed = 0});
    while (radiosity.shoot()) {
    }
    const std::vector<glm::dvec3> irradiance = radiosity.irradiance();
    double flux = 0.0;
    for (std::size_t e = 0; e < patches.elements(); ++e) {
      constexpr double kDarkRoom = 4.1;
      if (patches.centre[patches.patch[e]].x < kDarkRoom) continue;
      flux += patches.exposed_area(e) * irradiance[e].g;
    }
    return flux;
  };
  const double coarse = in_the_dark(32), fine = in_the_dark(128);
  // Without what touches what pixels see it is 4 % more.
  EXPECT_NEAR(coarse, fine, 0.02 * fine);
}

TEST(OccluderTextures, NeighboursAreThoseThatTouchAcrossTJunctionsToo) {
  // A square above, and below it two of half its width: their common corner is on its edge.
  Scene scene;
  const MaterialId grey = test::add_material(scene, 0.5f, 0.0f);
  test::add_quad(scene, grey, {0, 2, 0}, {2, 0, 0}, {0, 2, 0});
  test::add_quad(scene, grey, {0, 0, 0}, {1, 0, 0}, {0, 2, 0});
  test::add_quad(scene, grey, {1, 0, 0}, {1, 0, 0}, {0, 2, 0});
  test::add_quad(scene, grey, {5, 0, 0}, {1, 0, 0}, {0, 2, 0});
  const Patched squares(std::move(scene), 20);
  const auto neighbours = neighbours_of_triangles(squares.stage.world, squares.patches.mesh);
  ASSERT_EQ(neighbours.size(), 8u);
  // The triangle of the upper square that lies on the junction touches all below.
  EXPECT_THAT(neighbours[0], testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(neighbours[6], testing::ElementsAre(7));
}

TEST(GpuRadiosity, NeverLightsWhatNothingIsSeenFrom) {
  // A second room beside the lit one.
  Scene scene = test::box_room({2.0f, 2.0f, 2.0f}, 0.5f, 1.0f);
  const std::size_t lit = 12;
  Scene dark = test::box_room({2.0f, 2.0f, 2.0f}, 0.5f, 0.0f);
  const MaterialId grey = test::add_material(scene, 0.5f, 0.0f);
  for (Mesh& mesh : dark.meshes) {
    for (Vec3& p : mesh.positions) p.x += 2.5f;
    test::add_mesh(scene, grey, mesh.positions, mesh.triangles);
  }
  const gl::Context context;
  const Patched rooms(std::move(scene), 200);
  GpuRadiosity radiosity = rooms.radiosity(quick());
  while (radiosity.shoot()) {
  }
  const std::vector<glm::dvec3> irradiance = radiosity.irradiance();
  for (std::size_t e = 0; e < rooms.patches.elements(); ++e) {
    if (rooms.patches.mesh.faces[rooms.patches.patch[e]].source >= lit) {
      EXPECT_EQ(irradiance[e].g, 0.0) << e;
    }
  }
}

TEST(GpuRadiosity, PicturesGetBetterAsTexelsGetSmaller) {
  const gl::Context context;
  constexpr int kSize = 48;
  const Scene scene = furnished_room(true);
  RenderOptions options;
  options.camera.eye = Vec3(1.0f, 1.0f, 4.5f);
  options.camera.target = Vec3(1.0f, 1.0f, 0.0f);
  options.width = options.height = kSize;
  options.samples = 4;
  options.passes = 8;
  options.bound = 5.0f;
  options.compensate = true;
  const StopFlag stop{false};
  const Image reference = render(scene, options, stop).image;
  const auto error = [&](std::size_t count) {
    const Patched room(scene, count);
    GpuRadiosity radiosity = room.radiosity(quick());
    while (radiosity.shoot()) {
    }
    const Camera camera =
        choose_camera(room.stage.scene, room.stage.world, *room.stage.tracer, options.camera, 1.0f);
    const Display display(room.stage.scene, room.stage.world, room.patches);
    const Image image = display.draw(camera, radiosity.irradiance(),
                                     {.width = kSize, .height = kSize, .samples = 16}, stop);
    return compare(image, reference).relmse;
  };
  // A shadow's edge is as wide as an element: the square of that is the share of its pixels.
  // Thirteen times the elements and a factor of three leaves much of it to the noise of the
  // reference.
  const double coarse = error(60), fine = error(800);
  EXPECT_LT(3.0 * fine, coarse);
  EXPECT_LT(fine, 0.01);
}

TEST(GpuRadiosity, TexelsPlacedWhereTheLightVariesMakeBetterPicturesThanAsManyOfOneSize) {
  const Scene scene =
      load_scene(std::string(LANTERN_SOURCE_DIR) + "/scenes/cornell_box.scene", {}).scene;
  const StopFlag stop{false};
  RenderOptions options;
  options.width = options.height = 64;
  options.samples = 16;
  options.method = Method::kRadiosityProgressive;
  options.radiosity.patches.count = 3000;
  const Image reference = render(scene, options, stop).image;
  options.method = Method::kRadiosityGpu;
  options.radiosity.patches.count = 600;
  options.radiosity.hemicube.resolution = 32;
  options.radiosity.cutoff = 0.05;
  const auto error = [&](int refinements) {
    options.radiosity.refinements = refinements;
    const Rendered rendered = render(scene, options, stop);
    EXPECT_EQ(rendered.statistics.radiosity.rounds, static_cast<std::size_t>(refinements));
    EXPECT_LE(rendered.statistics.radiosity.patches, 600u);
    EXPECT_GT(rendered.statistics.radiosity.patches, 560u);
    return compare(rendered.image, reference).relmse;
  };
  const double placed = error(1), even = error(0);
  // 0.79 of it was seen; the rest is what few shots leave of noise.
  EXPECT_LT(placed, 0.9 * even);
}

TEST(ShooterTree, AnElementBeyondTheLimitsTakesSeveralShots) {
  const Patched room(furnished_room(false), 100);
  const ShooterTree tree(room.patches);
  const double radius = static_cast<double>(room.stage.world.bounds.radius());
  std::vector<double> flux(room.patches.elements(), 0.0);
  flux[0] = 1.0;
  const auto shots = [&](double emitted) {
    const std::vector<Cluster> chosen =
        tree.choose(flux, emitted, radius, {.spread = 1.0, .radius = 2.0});
    EXPECT_EQ(chosen.size(), 1u);
    return chosen.front().shots;
  };
  EXPECT_EQ(shots(1e6), 1u);
  EXPECT_EQ(shots(32.0), 8u);  // an eighth of what it has is the 256th of all
  EXPECT_EQ(shots(1.0), ElementPoints::kPoints);
}

}  // namespace
}  // namespace lantern
