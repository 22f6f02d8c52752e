// SPDX-License-Identifier: MIT
// Mean irradiance of every surface by the radiosity matrix against random walks of this test's own.
#include "lantern/load/load.h"
#include "lantern/radiosity/element_points.h"
#include "lantern/radiosity/form_factors.h"
#include "lantern/radiosity/random.h"
#include "lantern/radiosity/refinement.h"
#include "lantern/radiosity/solve.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace lantern {
namespace {

using glm::dvec3;

class RandomWalks {
 public:
  RandomWalks(const Scene& scene, const World& world, const Tracer& tracer)
      : scene_(scene), world_(world), tracer_(tracer) {
    for (std::uint32_t t = 0; t < world.size(); ++t) {
      if (!is_black(emission_at(scene, world, t, Vec2(0.3f), true))) emitters_.push_back(t);
    }
  }

  /// One estimate of the irradiance at a point that lies off its surface.
  dvec3 irradiance(Vec3 position, Vec3 normal, Random& random) const {
    dvec3 sum(0.0), throughput(1.0);
    while (true) {
      sum += throughput * direct(position, normal, random);
      const Vec3 direction = Frame(normal).to_world(random.cosine_direction());
      const Hit hit = tracer_.closest({.origin = position, .direction = direction});
      if (!hit) return sum;
      const SurfacePoint surface = surface_at(scene_, world_, hit.triangle, hit.uv);
      throughput *= dvec3(surface.reflectance);
      // Each bounce survives by the throughput that is left.
      const double survival = std::max({throughput.r, throughput.g, throughput.b});
      if (static_cast<double>(random.unit()) >= survival) return sum;
      throughput /= survival;
      const bool front = glm::dot(surface.geometric_normal, direction) < 0.0f;
      normal = front ? surface.geometric_normal : -surface.geometric_normal;
      position = off_surface(surface.position, normal, world_.coordinate_scale());
    }
  }

 private:
  dvec3 direct(const Vec3& position, const Vec3& normal, Random& random) const {
    const std::uint32_t emitter = emitters_[random.index(emitters_.size())];
    const Vec2 uv = random.in_triangle();
    const SurfacePoint there = surface_at(scene_, world_, emitter, uv);
    const Vec3 end = off_surface(there.position, there.geometric_normal, world_.coordinate_scale());
    const Vec3 way = end - position;
    const float here_cosine = glm::dot(way, normal),
                there_cosine = -glm::dot(way, there.geometric_normal);
    if (here_cosine <= 0.0f || there_cosine <= 0.0f ||
        tracer_.occluded({.origin = position, .direction = way, .far = 1.0f})) {
      return dvec3(0.0);
    }
    const float square = glm::dot(way, way);
    const float weight = here_cosine * there_cosine / (square * square) * world_.area(emitter) *
                         static_cast<float>(emitters_.size());
    return dvec3(emission_at(scene_, world_, emitter, uv, true) * weight);
  }

  const Scene& scene_;
  const World& world_;
  const Tracer& tracer_;
  std::vector<std::uint32_t> emitters_;
};

struct Surface {
  dvec3 matrix{0.0}, walks{0.0}, squares{0.0};
  double area = 0.0;
  std::vector<std::uint32_t> elements;
};

void expect_agreement(const std::string& file, std::size_t walks) {
  const Scene scene = load_scene(std::string(LANTERN_SOURCE_DIR) + "/scenes/" + file, {}).scene;
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  // As the command does: a solution on fewer patches tells where the others go.
  const StopFlag stop{false};
  Patches patches =
      make_patches(scene, world, *tracer, PatchOptions{.count = 1500, .size = std::nullopt});
  const auto solve = [&] {
    const FormFactors factors(world, *tracer, patches, stop);
    const std::vector<dvec3> none(patches.elements(), dvec3(0.0));
    return solve_by_gauss_seidel(patches, factors, none, {}, stop).irradiance;
  };
  PatchMesh mesh = patches.mesh;
  refine_highest(mesh, variations(patches, solve()), kVariationOfHalf, 3000);
  patches = make_patches(scene, world, *tracer, std::move(mesh), patches.lit);
  const std::vector<dvec3> irradiance = solve();

  // Quads, of two triangles of the world each, that reflect and that light can come to.
  std::map<std::uint32_t, Surface> surfaces;
  for (std::uint32_t e = 0; e < patches.size(); ++e) {
    if (patches.exposed[e] == 0.0 || patches.reflectance[e] == dvec3(0.0)) continue;
    Surface& surface = surfaces[patches.mesh.faces[e].source / 2];
    surface.matrix += patches.exposed_area(e) * irradiance[e];
    surface.area += patches.exposed_area(e);
    surface.elements.push_back(e);
  }
  const ElementPoints points(world, *tracer, patches);
  const RandomWalks tracing(scene, world, *tracer);
  std::vector<Surface*> all;
  for (auto& [quad, surface] : surfaces) all.push_back(&surface);
  parallel_for(all.size(), 1, [&](std::size_t s) {
    Surface& surface = *all[s];
    Random random(hash(s));
    // Steps of equal area through the elements.
    const double step = surface.area / static_cast<double>(walks);
    double next = 0.5 * step, passed = 0.0;
    for (const std::uint32_t e : surface.elements) {
      passed += patches.exposed_area(e);
      for (; next < passed; next += step) {
        const dvec3 sample = tracing.irradiance(points.at(e, random.index(ElementPoints::kPoints)),
                                                Vec3(patches.normal[e]), random);
        surface.walks += sample;
        surface.squares += sample * sample;
      }
    }
  });
  EXPECT_GT(all.size(), 8u);
  const auto n = static_cast<double>(walks);
  for (const Surface* surface : all) {
    const dvec3 expected = surface->walks / n, found = surface->matrix / surface->area;
    for (int c = 0; c < 3; ++c) {
      const double variance = surface->squares[c] / n - expected[c] * expected[c];
      const double error = std::sqrt(variance / n);
      // What is asked of methods, and what the walks leave uncertain.
      EXPECT_NEAR(found[c], expected[c], 0.01 * expected[c] + 3.0 * error)
          << file << ", " << surface->area << " m2, standard error " << error / expected[c];
    }
  }
}

TEST(RadiosityAgreement, MeansOfSurfacesInTheCornellBox) {
  expect_agreement("cornell_box.scene", 50'000);
}

TEST(RadiosityAgreement, MeansOfSurfacesInTwoRooms) { expect_agreement("two_rooms.scene", 50'000); }

}  // namespace
}  // namespace lantern
