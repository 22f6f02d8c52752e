// SPDX-License-Identifier: MIT
// A baked file shows what the solution shows: read back, by our own loader and by assimp, its
// colours are the picture, without any light.
#include "lantern/core/file.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/bake_scene.h"
#include "lantern/pipeline/camera.h"
#include "lantern/radiosity/display.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"
#include "lantern/trace/eye.h"

#include "tests/analytic/rooms.h"
#include "tests/support/temporary_folder.h"

#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace lantern {
namespace {

constexpr int kSize = 48;

/// What a viewer of unlit materials shows: the colour of the surface, of its front alone.
Image unlit_view(const Scene& scene, const Camera& camera) {
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Eye eye(camera, kSize, kSize);
  Image image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Vec3 direction =
          eye.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Hit hit = tracer->closest({.origin = eye.origin(), .direction = direction});
      if (!hit || glm::dot(world.area_vector(hit.triangle), direction) > 0.0f) continue;
      image.at(x, y) = surface_at(scene, world, hit.triangle, hit.uv).reflectance;
    }
  }
  return image;
}

/// A lit scene and its solution; some irradiance will do, it need not be the right one.
struct Lit {
  Scene scene;
  World world;
  std::unique_ptr<Tracer> tracer;
  Patches patches;
  std::vector<glm::dvec3> irradiance;
  Camera camera;

  explicit Lit(Scene given, std::size_t count = 600)
      : scene(std::move(given)),
        world(make_world(scene)),
        tracer(make_embree_tracer(scene, world)),
        patches(make_patches(scene, world, *tracer, PatchOptions{.count = count})),
        camera(choose_camera(scene, world, *tracer, {}, 1.0f)) {
    for (std::uint32_t e = 0; e < patches.elements(); ++e) {
      const glm::dvec3 c = patches.centre[patches.patch[e]];
      irradiance.emplace_back(2.0 + std::sin(c.x), 2.0 + std::sin(c.y), 2.0 + std::cos(c.z));
    }
  }
  Image picture() const {
    const StopFlag stop{false};
    return Display(scene, world, patches)
        .draw(camera, irradiance, {.width = kSize, .height = kSize, .samples = 1}, stop);
  }
  Baked baked(bool vertex_colours, bool lightmap) const {
    BakeOptions options;
    options.vertex_colours = vertex_colours;
    std::optional<Atlas> atlas;
    if (lightmap) atlas = make_atlas(world, patches, 512);
    return bake(Solution(scene, world, patches, irradiance), world, atlas ? &*atlas : nullptr,
                options);
  }
};

Scene cornell_box() {
  return load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/cornell_box.scene").scene;
}

/// A floor with a texture of 8x8 colours below a lamp.
Scene textured_floor() {
  Scene scene;
  const MaterialId floor = test::add_material(scene, 0.9f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.0f, 5.0f);
  test::add_quad(scene, floor, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  test::add_quad(scene, lamp, Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  Texture& texture = scene.textures.emplace_back();
  texture.name = "colours";
  texture.width = texture.height = 8;
  for (int i = 0; i < 64; ++i) {
    for (const int c : {16 + 3 * i, 255 - 3 * i, 40 * (i % 5), 255}) {
      texture.srgb8.push_back(static_cast<std::uint8_t>(c));
    }
  }
  scene.materials[index(floor)].reflectance_texture = TextureId{0};
  scene.cameras.push_back({"eye", Vec3(0.0f, 1.5f, 3.5f), glm::normalize(Vec3(0.0f, -0.5f, -1.0f)),
                           Vec3(0.0f, 1.0f, 0.0f), 0.9f});
  return scene;
}

Scene read_back(const Baked& baked, const test::TemporaryFolder& folder) {
  write_file(folder / "baked.glb", baked.file);
  return load_scene(folder / "baked.glb").scene;
}

/// Share of the pixels whose channels all differ by less than `most`; what is clipped is left out.
double share_alike(const Image& view, const Image& picture, float white, float most) {
  std::size_t alike = 0, all = 0;
  for (std::size_t i = 0; i < view.pixels.size(); ++i) {
    const Rgb expected = picture.pixels[i] / white;
    if (max_component(expected) > 1.0f) continue;
    ++all;
    alike += max_component(glm::abs(view.pixels[i] - expected)) < most ? 1 : 0;
  }
  EXPECT_GT(all, view.pixels.size() / 2);
  return static_cast<double>(alike) / static_cast<double>(all);
}

// The same triangles, the same linear interpolation: floats apart, but for the pixels (here none or
// a few) whose ray meets an edge.
TEST(Bake, VertexColoursAreThePicture) {
  const test::TemporaryFolder folder;
  for (const Scene& scene : {cornell_box(), textured_floor()}) {
    const Lit lit(scene);
    for (const bool with_lightmap : {false, true}) {
      const Baked baked = lit.baked(true, with_lightmap);
      const Image view = unlit_view(read_back(baked, folder), lit.camera);
      EXPECT_GT(share_alike(view, lit.picture(), baked.radiance_of_white, 1e-4f), 0.995);
    }
  }
}

// Bilinear texels of 8-bit sRGB: half a step is up to 0.0045 near white, and between texels the
// kinks of the interpolation are rounded.
TEST(Bake, TheLightmapIsThePicture) {
  const test::TemporaryFolder folder;
  const Lit lit(cornell_box());
  const Baked baked = lit.baked(false, true);
  const Image view = unlit_view(read_back(baked, folder), lit.camera);
  EXPECT_GT(share_alike(view, lit.picture(), baked.radiance_of_white, 0.01f), 0.99);
}

TEST(Bake, TheLightmapHoldsTextures) {
  const test::TemporaryFolder folder;
  const Lit lit(textured_floor());
  const Baked baked = lit.baked(false, true);
  const Image view = unlit_view(read_back(baked, folder), lit.camera);
  // The texture of 8 texels over 4 m has its kinks at texels of the lightmap too, 2 % at most.
  EXPECT_GT(share_alike(view, lit.picture(), baked.radiance_of_white, 0.02f), 0.98);
}

// A sheet lit from both sides is there twice, each side with its own light.
TEST(Bake, SheetsHaveTwoSides) {
  const test::TemporaryFolder folder;
  Scene scene;
  const MaterialId sheet = test::add_material(scene, 0.5f, 0.0f);
  const MaterialId lamp = test::add_material(scene, 0.0f, 5.0f);
  test::add_quad(scene, sheet, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  test::add_quad(scene, lamp, Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  test::add_quad(scene, lamp, Vec3(-1, -2, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  Lit lit(std::move(scene), 6);
  ASSERT_EQ(lit.patches.elements() - lit.patches.size(), 2u) << "both sides of the sheet are lit";
  for (std::uint32_t e = 0; e < lit.patches.elements(); ++e) {
    lit.irradiance[e] = glm::dvec3(lit.patches.is_front(e) ? 1.0 : 3.0);
  }
  const Baked baked = lit.baked(true, true);
  EXPECT_EQ(baked.triangles, lit.patches.elements());
  const Scene read = read_back(baked, folder);
  const World world = make_world(read);
  int up = 0, down = 0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const Vec3 normal = glm::normalize(world.area_vector(t));
    if (std::abs(world.positions[world.triangles[t].x].y) > 0.5f) continue;  // a lamp
    const float expected =
        0.5f * (normal.y > 0.0f ? 1.0f : 3.0f) * kInvPi / baked.radiance_of_white;
    EXPECT_NEAR(surface_at(read, world, t, Vec2(0.3f)).reflectance.g, expected, 1e-5f);
    ++(normal.y > 0.0f ? up : down);
  }
  EXPECT_EQ(up, 2);
  EXPECT_EQ(down, 2);
}

// assimp reads the first scene alone, as most viewers show it alone: of the file with both the
// coloured one.
TEST(Bake, AssimpFindsColoursAndBothSetsOfCoordinates) {
  const test::TemporaryFolder folder;
  const Lit lit(textured_floor(), 100);
  for (const auto& [coloured, mapped] : {std::pair(true, true), {true, false}, {false, true}}) {
    write_file(folder / "baked.glb", lit.baked(coloured, mapped).file);
    Assimp::Importer importer;
    const aiScene* read =
        importer.ReadFile((folder / "baked.glb").string(), aiProcess_ValidateDataStructure);
    ASSERT_NE(read, nullptr) << importer.GetErrorString();
    EXPECT_EQ(read->mNumMeshes, 2u);    // the floor and the lamp
    EXPECT_EQ(read->mNumTextures, 1u);  // the floor's, or the lightmap
    unsigned triangles = 0;
    for (unsigned m = 0; m < read->mNumMeshes; ++m) {
      const aiMesh& mesh = *read->mMeshes[m];
      triangles += mesh.mNumFaces;
      EXPECT_TRUE(mesh.HasNormals());
      EXPECT_TRUE(mesh.HasTextureCoords(0));
      EXPECT_EQ(mesh.HasTextureCoords(1), mapped);
      EXPECT_EQ(mesh.HasVertexColors(0), coloured);
      if (!coloured) {
        int set = 0;
        const aiMaterial& material = *read->mMaterials[mesh.mMaterialIndex];
        EXPECT_EQ(material.Get(AI_MATKEY_UVWSRC(aiTextureType_BASE_COLOR, 0), set), AI_SUCCESS);
        EXPECT_EQ(set, 1);
        continue;
      }
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiColor4D& colour = mesh.mColors[0][v];
        EXPECT_GT(std::min({colour.r, colour.g, colour.b}), 0.0f);
        EXPECT_LE(std::max({colour.r, colour.g, colour.b}), 1.0f);
        EXPECT_EQ(colour.a, 1.0f);
      }
    }
    EXPECT_EQ(triangles, lit.patches.elements());
  }
}

TEST(Bake, TheSameBytesOnAnyNumberOfThreads) {
  BakeSceneOptions options;
  options.patches.count = 300;
  options.radiosity.cutoff = 0.05;
  options.lightmap_size = 64;
  const Scene scene = cornell_box();
  const StopFlag stop{false};
  std::vector<std::byte> one, three;
  ThreadScope(1).run([&] { one = bake_scene(scene, options, stop).baked.file; });
  ThreadScope(3).run([&] { three = bake_scene(scene, options, stop).baked.file; });
  EXPECT_EQ(one, three);
}

// Inside the furnace all that is seen is E/(1-a) = 2, of which the half is reflected: white is that
// of the emitters, since nothing else is there.
TEST(Bake, TheFurnaceIsEvenlyLit) {
  const test::TemporaryFolder folder;
  BakeSceneOptions options;
  options.patches.count = 500;
  const Scene scene =
      load_scene(std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/furnace.scene").scene;
  const StopFlag stop{false};
  const BakedScene baked = bake_scene(scene, options, stop);
  const Scene read = read_back(baked.baked, folder);
  const World world = make_world(read);
  double sum = 0.0;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    const float shown =
        surface_at(read, world, t, Vec2(1.0f / 3.0f)).reflectance.g * baked.baked.radiance_of_white;
    // Light arrives in shots of coarse hemicubes: a few percent at each patch, whose sum is right.
    EXPECT_NEAR(shown, 2.0f, 0.2f);
    sum += static_cast<double>(shown * world.area(t));
  }
  EXPECT_NEAR(sum / test::total_area(world), 2.0, 0.01);
}

}  // namespace
}  // namespace lantern
