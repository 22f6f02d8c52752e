// SPDX-License-Identifier: MIT
// Radiosity by matrix against rooms whose light is known in closed form.
#include "lantern/radiosity/external_light.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/polygon_factor.h"
#include "lantern/radiosity/solve.h"
#include "lantern/trace/embree.h"

#include "tests/analytic/rooms.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lantern {
namespace {

using glm::dvec3;

constexpr double kPiD = std::numbers::pi;

struct Room {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;
  Patches patches;
  StopFlag stop{false};
  FormFactors factors;
  std::vector<dvec3> external;

  Room(Scene given, std::size_t count)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)),
        patches(make_patches(scene, world, *tracer, PatchOptions{.count = count})),
        factors(world, *tracer, patches, stop),
        external(external_irradiance(scene, world, *tracer, patches, stop)) {}

  std::vector<dvec3> irradiance() const {
    return solve_by_gauss_seidel(patches, factors, external, {}, stop).irradiance;
  }
  /// Mean over the elements that `belongs` says.
  template <typename Belongs>
  dvec3 mean(const std::vector<dvec3>& values, Belongs belongs) const {
    dvec3 sum(0.0);
    double area = 0.0;
    for (std::size_t e = 0; e < values.size(); ++e) {
      if (!belongs(e)) continue;
      sum += patches.exposed_area(e) * values[e];
      area += patches.exposed_area(e);
    }
    return sum / area;
  }
};

TEST(RadiosityMatrix, AFurnaceGivesEmissionOverOneLessReflectance) {
  for (const float reflectance : {0.0f, 0.5f, 0.9f}) {
    const Room box(test::box_room(Vec3(1, 2, 3), reflectance, 1.0f), 300);
    const Room ball(test::sphere_room(2, reflectance, 1.0f), 300);
    for (const Room* room : {&box, &ball}) {
      const double radiance = 1.0 / (1.0 - static_cast<double>(reflectance));
      for (const dvec3& e : room->irradiance()) {
        // The error of a row sum adds up over 1 / (1 - reflectance) bounces.
        EXPECT_NEAR(e.g / kPiD / radiance, 1.0, 1e-3 * radiance);
      }
    }
  }
}

/// A cube whose floor alone emits. [Goral et al. 1984 compute such a box without occluders]
Scene goral_box(const float (&reflectances)[6]) {
  Scene scene = test::box_room(Vec3(2, 2, 2), 0.0f, 0.0f);
  scene.materials.clear();
  for (int wall = 0; wall < 6; ++wall) {
    scene.meshes[static_cast<std::size_t>(wall)].material =
        test::add_material(scene, reflectances[wall], wall == 0 ? 1.0f : 0.0f);
  }
  return scene;
}

TEST(RadiosityMatrix, DirectLightInGoralsBoxIsThatOfItsWallsFormFactors) {
  const Room room(goral_box({0, 0, 0, 0, 0, 0}), 600);
  const std::vector<dvec3> irradiance = room.irradiance();
  // Howell C-11 and C-14 for a cube.
  const double opposite = 0.19982489569838746, adjacent = 0.20004377607540315;
  for (std::uint32_t wall = 1; wall < 6; ++wall) {
    const dvec3 mean = room.mean(
        irradiance, [&](std::size_t e) { return room.patches.mesh.faces[e].source / 2 == wall; });
    EXPECT_NEAR(mean.g, kPiD * (wall == 3 ? opposite : adjacent), 1e-3 * kPiD * adjacent) << wall;
  }
}

TEST(RadiosityMatrix, WhatIsEmittedInGoralsBoxIsAbsorbedThere) {
  const float reflectances[6] = {0.3f, 0.5f, 0.7f, 0.2f, 0.6f, 0.4f};
  const Room room(goral_box(reflectances), 1200);
  const std::vector<dvec3> irradiance = room.irradiance();
  double absorbed = 0.0, emitted = 0.0;
  for (std::size_t e = 0; e < room.patches.elements(); ++e) {
    const double rho = room.patches.reflectance[room.patches.patch[e]].g;
    absorbed += room.patches.exposed_area(e) * (1.0 - rho) * irradiance[e].g;
    emitted += room.patches.exposed_area(e) * room.patches.emission[e].g;
  }
  // The row sums' error.
  EXPECT_NEAR(absorbed / emitted, 1.0, 1e-3);
}

TEST(RadiosityMatrix, EliminationAndGaussSeidelAgree) {
  Scene scene = goral_box({0.3f, 0.5f, 0.9f, 0.2f, 0.6f, 0.95f});
  scene.materials[2].reflectance = Rgb(0.9f, 0.1f, 0.4f);
  const Room room(std::move(scene), 400);
  const std::vector<dvec3> a = room.irradiance();
  const std::vector<dvec3> b = solve_by_elimination(room.patches, room.factors, room.external);
  for (std::size_t e = 0; e < a.size(); ++e) {
    // The sweeps end when they change less than 1e-9 of the largest radiosity, π.
    EXPECT_LT(glm::distance(a[e], b[e]), 1e-6);
  }
}

TEST(RadiosityMatrix, ASphereMakesAllIrradianceUniform) {
  // In a sphere every two elements have the same factor, so that one emitting part lights all
  // alike: E = ρ-independent flux / area / (1 - ρ).
  Scene scene = test::sphere_room(3, 0.6f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.6f, 5.0f);
  Mesh part = scene.meshes[0];
  part.triangles.resize(40);
  part.material = lamp;
  scene.meshes[0].triangles.erase(scene.meshes[0].triangles.begin(),
                                  scene.meshes[0].triangles.begin() + 40);
  scene.instances.emplace_back().mesh = static_cast<MeshId>(scene.meshes.size());
  scene.meshes.push_back(std::move(part));
  const Room room(std::move(scene), 512);
  const std::vector<dvec3> irradiance = room.irradiance();
  double flux = 0.0, area = 0.0;
  for (std::size_t e = 0; e < room.patches.elements(); ++e) {
    flux += room.patches.exposed_area(e) * room.patches.emission[e].g;
    area += room.patches.exposed_area(e);
  }
  const dvec3 mean = room.mean(irradiance, [](std::size_t) { return true; });
  // Facets are flat and meet at angles: of those next to the lamp some get more, some less.
  EXPECT_NEAR(mean.g / (flux / area / (1.0 - 0.6)), 1.0, 1e-3);
  for (const dvec3& e : irradiance) EXPECT_NEAR(e.g / mean.g, 1.0, 0.1);
}

TEST(RadiosityMatrix, BothSidesOfAScreenHaveTheirOwnLight) {
  Scene scene = test::box_room(Vec3(2, 2, 2), 0.0f, 0.0f);
  // The wall at x = -1 emits; a screen across the middle of the room takes its light.
  scene.meshes[0].material = test::add_material(scene, 0.0f, 1.0f);
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(0, -1, -1), Vec3(0, 2, 0),
                 Vec3(0, 0, 2));
  const Room room(std::move(scene), 600);
  const std::vector<dvec3> irradiance = room.irradiance();
  const auto of_screen = [&](std::size_t e) {
    return room.patches.mesh.faces[room.patches.patch[e]].source >= 12;
  };
  const double lit = room.mean(irradiance,
                               [&](std::size_t e) {
                                 return of_screen(e) && room.patches.element_normal(e).x < 0.0;
                               })
                         .g;
  const auto unlit = [&](std::size_t e) {
    return of_screen(e) && room.patches.element_normal(e).x > 0.0;
  };
  // C-11 at half the distance of the sides' length.
  EXPECT_NEAR(lit, kPiD * 0.41525, 2e-3);
  for (std::size_t e = 0; e < irradiance.size(); ++e) {
    if (unlit(e)) {
      EXPECT_EQ(irradiance[e].g, 0.0);
    }
  }
}

TEST(RadiosityMatrix, TheSkyLightsAnOpenFloorByPi) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(0), Vec3(0, 0, 1),
                 Vec3(1, 0, 0));
  scene.sky = Sky{};
  scene.sky->radiance = Rgb(2.0f, 1.0f, 0.5f);
  const Room room(std::move(scene), 32);
  EXPECT_EQ(room.patches.elements(), 2 * room.patches.size());
  for (const dvec3& e : room.irradiance()) {
    EXPECT_NEAR(e.r, 2.0 * kPiD, 1e-5);
    EXPECT_NEAR(e.b, 0.5 * kPiD, 1e-5);
  }
}

TEST(RadiosityMatrix, ATexturedSkyOfOneColourIsThatColour) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, 0.5f, 0.0f), Vec3(0), Vec3(0, 0, 1),
                 Vec3(1, 0, 0));
  Texture& texture = scene.textures.emplace_back();
  texture.width = 16;
  texture.height = 8;
  for (int i = 0; i < 16 * 8; ++i) texture.linear.insert(texture.linear.end(), {0.25f, 0.5f, 1, 1});
  scene.sky = Sky{};
  scene.sky->texture = TextureId{};
  const Room room(std::move(scene), 64);
  const dvec3 mean = room.mean(room.irradiance(), [](std::size_t) { return true; });
  // 36 stratified directions at each of 64 * 2 * 16 points.
  EXPECT_NEAR(mean.g, 0.5 * kPiD, 5e-3);
}

TEST(RadiosityMatrix, PunctualLightsFollowTheirLaws) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, 0.0f, 0.0f), Vec3(-0.01f, 0, -0.01f),
                 Vec3(0, 0, 0.02f), Vec3(0.02f, 0, 0));
  const auto light = [&](PunctualKind kind, const Vec3& position, const Vec3& direction) {
    PunctualLight& l = scene.lights.emplace_back();
    l.kind = kind;
    l.intensity = Rgb(3.0f);
    l.position = position;
    l.direction = glm::normalize(direction);
  };
  const auto irradiance = [&] {
    const Room room(scene, 4);
    return room.mean(room.irradiance(), [&](std::size_t e) { return room.patches.is_front(e); }).g;
  };
  // The floor is 2 cm wide: what varies over it does so by about 1e-4.
  light(PunctualKind::kPoint, Vec3(1, 2, 0), Vec3(0, -1, 0));
  EXPECT_NEAR(irradiance(), 3.0 * 2.0 / std::pow(5.0, 1.5), 1e-3);
  scene.lights.clear();
  light(PunctualKind::kDirectional, Vec3(0), Vec3(0, -1, 1));
  EXPECT_NEAR(irradiance(), 3.0 / std::sqrt(2.0), 1e-5);
  scene.lights.clear();
  light(PunctualKind::kSpot, Vec3(0, 2, 0), Vec3(0, -1, 0));
  EXPECT_NEAR(irradiance(), 3.0 / 4.0, 1e-3);
  scene.lights.back().direction = Vec3(1, 0, 0);
  EXPECT_EQ(irradiance(), 0.0);
}

}  // namespace
}  // namespace lantern
