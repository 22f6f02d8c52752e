// SPDX-License-Identifier: MIT
// Radiosity by hemicubes and by shooting against path tracing, surface by surface, and against the
// reference that other renderers agree on.
#include "lantern/image/compare.h"
#include "lantern/image/read.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/camera.h"
#include "lantern/pipeline/render.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/eye.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace lantern {
namespace {

Image picture(const Scene& scene, const RenderOptions& options) {
  const StopFlag never{false};
  return render(scene, options, never).image;
}

/// What a pixel shows: a material and a side of the room.
using Surface = std::tuple<MaterialId, int, int, int>;

/// The pixels of each surface, but for those near its border.
std::map<Surface, std::vector<std::size_t>> pixels_of_surfaces(const Scene& scene, int size) {
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Eye eye(choose_camera(scene, world, *tracer, {}, 1.0f), size, size);
  const auto surface_at_place = [&](float x, float y) -> std::optional<Surface> {
    const Hit hit = tracer->closest({.origin = eye.origin(), .direction = eye.direction(x, y)});
    if (!hit) return std::nullopt;
    const Vec3 n = glm::normalize(world.area_vector(hit.triangle)) * 8.0f;
    return Surface{world.materials[hit.triangle], static_cast<int>(std::lround(n.x)),
                   static_cast<int>(std::lround(n.y)), static_cast<int>(std::lround(n.z))};
  };
  std::map<Surface, std::vector<std::size_t>> pixels;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const auto surface = surface_at_place(fx + 0.5f, fy + 0.5f);
      if (!surface) continue;
      bool inside = true;
      for (const Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        inside = inside && surface_at_place(fx + corner.x, fy + corner.y) == surface;
      }
      if (inside) pixels[*surface].push_back(static_cast<std::size_t>(y * size + x));
    }
  }
  return pixels;
}

TEST(HemicubeAgreement, MeansOfSurfacesAreThoseOfPathTracing) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "too slow with sanitizers";
#endif
  constexpr int kSize = 96;
  for (const std::string name : {"cornell_box.scene", "two_rooms.scene"}) {
    const Scene scene =
        load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name).scene;
    RenderOptions options;
    options.width = options.height = kSize;
    options.method = Method::kPath;
    options.samples = 256;
    const Image path = picture(scene, options);
    options.samples = 16;
    options.radiosity.patches.count = 5000;
    const auto surfaces = pixels_of_surfaces(scene, kSize);
    for (const Method method : {Method::kRadiosityHemicube, Method::kRadiosityProgressive}) {
      options.method = method;
      const Image radiosity = picture(scene, options);
      // Of fewer pixels path tracing with these samples leaves more than a third of a per cent of
      // noise.
      constexpr std::size_t kFewest = 150;
      const auto mean = [](const Image& image, const std::vector<std::size_t>& pixels) {
        double sum = 0.0;
        for (const std::size_t p : pixels)
          sum += static_cast<double>(mean_component(image.pixels[p]));
        return sum / static_cast<double>(pixels.size());
      };
      double brightest = 0.0;
      for (const auto& [surface, pixels] : surfaces) {
        // Lamps aside, which every method shows as they are.
        if (pixels.size() >= kFewest) brightest = std::max(brightest, mean(path, pixels));
      }
      int compared = 0;
      for (const auto& [surface, pixels] : surfaces) {
        if (pixels.size() < kFewest) continue;
        ++compared;
        const double expected = mean(path, pixels);
        // What is asked of methods where light comes to, and in the dark what patches of one size
        // let in that lie half in the light.
        EXPECT_NEAR(mean(radiosity, pixels), expected, 0.01 * expected + 0.001 * brightest)
            << name << ", method " << static_cast<int>(method) << ", normal "
            << std::get<1>(surface) << " " << std::get<2>(surface) << " " << std::get<3>(surface)
            << ", " << pixels.size() << " pixels";
      }
      EXPECT_GE(compared, 5) << name;
    }
  }
}

TEST(HemicubeAgreement, ErrorAgainstTheReferenceFallsWithThePatches) {
#ifdef LANTERN_SANITIZED
  GTEST_SKIP() << "too slow with sanitizers";
#endif
  const auto folder = test::shared_folder("reference");
  if (!folder) GTEST_SKIP() << "no reference";
  const Scene scene = load_scene(*folder / "cornell_box.obj").scene;
  const Image reference = read_image(*folder / "cornell_box.exr");
  RenderOptions options;
  options.width = reference.width;
  options.height = reference.height;
  options.samples = 16;
  options.camera.eye = Vec3(2.78f, 2.73f, -8.0f);
  options.camera.target = Vec3(2.78f, 2.73f, 0.0f);
  options.camera.vertical_fov = glm::radians(39.3076f);
  for (const Method method : {Method::kRadiosityHemicube, Method::kRadiosityProgressive}) {
    options.method = method;
    double coarse = 0.0;
    for (const std::size_t count : {400, 1600}) {
      options.radiosity.patches.count = count;
      const double relmse = compare(picture(scene, options), reference).relmse;
      // Half the edge of the patches; the error of linear interpolation would be sixteen times
      // less, that of shadow borders half, and grain stays.
      if (coarse > 0.0) {
        EXPECT_LT(relmse, 0.5 * coarse);
      }
      coarse = relmse;
    }
    EXPECT_LT(coarse, 1.2e-3);
  }
}

}  // namespace
}  // namespace lantern
