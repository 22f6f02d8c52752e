// SPDX-License-Identifier: MIT
// Whole files: Lantern's own scenes, and third-party ones where they are at hand.
#include "lantern/core/file.h"
#include "lantern/load/dotscene.h"
#include "lantern/load/ogre_binary.h"
#include "lantern/load/ogre_material.h"
#include "lantern/load/ogre_xml.h"
#include "lantern/scene/validate.h"
#include "lantern/scene/world.h"

#include "tests/load/ogre_files.h"
#include "tests/support/temporary_folder.h"

#include <chrono>

namespace lantern {
namespace {

using test::error_of;
using ::testing::StartsWith;

std::filesystem::path own(const std::string& name) {
  return std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name;
}

Loaded load_own(const std::string& name) {
  Loaded loaded = load_dotscene(own(name), {});
  EXPECT_TRUE(validate(loaded.scene, name).empty());
  EXPECT_TRUE(loaded.report.warnings.empty());
  EXPECT_TRUE(loaded.report.unknown.empty());
  EXPECT_EQ(loaded.scene.cameras.size(), 1u);
  return loaded;
}

/// Volume inside a closed surface that faces outward (divergence theorem), m³.
double volume(const World& world) {
  double sum = 0.0;
  for (const uvec3& t : world.triangles) {
    const glm::dvec3 a = world.positions[t.x], b = world.positions[t.y], c = world.positions[t.z];
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

double total_flux(const Scene& scene, const World& world) {
  double flux = 0.0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& m = scene.materials[index(world.materials[t])];
    flux += mean_component(m.emission) * world.area(t) * kPi;
  }
  return flux;
}

TEST(OwnScenes, CornellBoxIsThePublishedOne) {
  const Loaded loaded = load_own("cornell_box.scene");
  const World world = make_world(loaded.scene);
  EXPECT_EQ(world.size(), 32u);
  EXPECT_EQ(loaded.scene.materials.size(), 4u);
  const Camera& camera = loaded.scene.cameras[0];
  EXPECT_EQ(camera.eye, Vec3(2.78f, 2.73f, -8));
  EXPECT_EQ(camera.forward, Vec3(0, 0, 1));
  EXPECT_EQ(camera.up, Vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(camera.vertical_fov, glm::radians(39.3076f));
  double lamp = 0.0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Material& m = loaded.scene.materials[index(world.materials[t])];
    if (m.name != "cornell/light") continue;
    EXPECT_EQ(m.emission, Rgb(17, 12, 4));
    EXPECT_EQ(m.reflectance, Rgb(0));
    EXPECT_LT(world.area_vector(t).y, 0.0f);
    lamp += world.area(t);
  }
  EXPECT_NEAR(lamp, 1.3 * 1.05, 1e-5);
}

TEST(OwnScenes, FurnaceFacesInward) {
  const Loaded loaded = load_own("furnace.scene");
  EXPECT_NEAR(volume(make_world(loaded.scene)), -8.0, 1e-6);
  EXPECT_EQ(loaded.scene.materials.at(0).reflectance, Rgb(0.5f));
  EXPECT_EQ(loaded.scene.materials.at(0).emission, Rgb(1));
}

TEST(OwnScenes, TwoRoomsAreSolidWallsFacingOutOfThem) {
  const Loaded loaded = load_own("two_rooms.scene");
  const double walls = 8.3 * 3.2 * 4.2 - 2 * 4 * 3 * 4 - 0.1 * 0.9 * 2.1;
  const double lamp = 0.6 * 0.05 * 0.6, table = 1.2 * 0.75 * 1.2;
  EXPECT_NEAR(volume(make_world(loaded.scene)), walls + lamp + table, 1e-4);
}

TEST(OwnScenes, ManyEmittersOfManySizes) {
  const Loaded loaded = load_own("many_emitters.scene");
  int emitters = 0;
  for (const Mesh& mesh : loaded.scene.meshes) {
    emitters += !is_black(loaded.scene.materials[index(mesh.material)].emission);
  }
  EXPECT_EQ(emitters, 12);
  EXPECT_GT(total_flux(loaded.scene, make_world(loaded.scene)), 10.0);
}

TEST(OwnScenes, TruncatedAnywhereTheyAreErrors) {
  const auto check = [](const std::string& text, const std::string& end, const auto& parse) {
    const std::size_t last = text.rfind(end) + end.size();
    for (std::size_t size = 0; size < last; size += 64) {
      EXPECT_THAT(error_of([&] { parse(text.substr(0, size)); }), StartsWith("f")) << size;
    }
  };
  LoadReport report;
  check(read_text(own("two_rooms.mesh.xml")), "</mesh>",
        [&](const std::string& text) { ogre::parse_xml(text, "f", report); });
  check(read_text(own("two_rooms.scene")), "</scene>",
        [&](const std::string& text) { ogre::parse_dotscene(text, "f", report); });
}

class SharedScenes : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::shared_folder("scenes/ogre");
    if (!folder) GTEST_SKIP() << "the shared Ogre scenes are not there";
    folder_ = *folder;
  }
  std::filesystem::path folder_;
};

std::size_t triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
  return count;
}

TEST_F(SharedScenes, Cornell) {
  const Loaded loaded = load_ogre_binary(folder_ / "cornell.mesh", {});
  EXPECT_EQ(loaded.report.format, "Ogre mesh 1.100, little-endian");
  EXPECT_EQ(triangles(loaded.scene), 138u);
  EXPECT_TRUE(loaded.report.warnings.empty());
  EXPECT_TRUE(loaded.report.unknown.empty());
  ASSERT_EQ(loaded.scene.materials.size(), 1u);
  EXPECT_EQ(loaded.scene.materials[0].name, "BaseWhite");
}

TEST_F(SharedScenes, Sibenik) {
  const Loaded loaded = load_ogre_binary(folder_ / "sibenik.mesh", {});
  EXPECT_EQ(loaded.report.format, "Ogre mesh 1.100, little-endian");
  EXPECT_EQ(triangles(loaded.scene), 80479u);
  EXPECT_EQ(loaded.scene.meshes.size(), 18u);
  EXPECT_EQ(loaded.scene.materials.size(), 18u);
  EXPECT_EQ(loaded.scene.textures.size(), 3u);
  EXPECT_TRUE(loaded.report.warnings.empty()) << loaded.report.warnings[0];
  EXPECT_TRUE(loaded.report.unknown.empty()) << loaded.report.unknown.begin()->first;
}

TEST_F(SharedScenes, SibenikIsParsedInAFractionOfASecond) {
  const auto bytes = read_file(folder_ / "sibenik.mesh");
  LoadReport report;
  const auto start = std::chrono::steady_clock::now();
  ogre::parse_binary(bytes, "sibenik.mesh", report);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  // 0.01 s optimised; a sanitizer takes ten times as long, a loaded machine again so.
  EXPECT_LT(seconds.count(), 2.0);
}

TEST_F(SharedScenes, TruncatedCornellIsAnError) {
  const auto bytes = read_file(folder_ / "cornell.mesh");
  for (std::size_t size = 0; size < bytes.size(); size += 64) {
    LoadReport report;
    EXPECT_THAT(error_of([&] { ogre::parse_binary(std::span(bytes).first(size), "f", report); }),
                StartsWith("f: byte "))
        << size;
  }
}

}  // namespace
}  // namespace lantern
