// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/scene/subdivide.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"
#include "lantern/scene/validate.h"
#include "lantern/scene/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lantern {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The right triangle (0,0,0) (1,0,0) (0,1,0), its front towards +z.
Scene one_triangle() {
  Scene scene;
  scene.materials.emplace_back().name = "m";
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "t";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.instances.emplace_back();
  return scene;
}

/// Linear texels, so that expected values are exact.
Texture texture_of(int width, int height, const std::vector<float>& greys) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  for (float grey : greys) texture.linear.insert(texture.linear.end(), {grey, grey, grey, 1.0f});
  return texture;
}

// --- validate()
// ------------------------------------------------------------------------------------

TEST(Validate, LeavesAValidSceneAlone) {
  Scene scene = one_triangle();
  scene.cameras.emplace_back();
  scene.lights.emplace_back();
  scene.sky = Sky{};
  EXPECT_THAT(validate(scene, "f"), IsEmpty());
  EXPECT_EQ(scene.meshes[0].triangles.size(), 1u);
}

struct Broken {
  const char* message;
  std::function<void(Scene&)> change;
};

const float kNan = std::nanf("");

const std::vector<Broken> kBroken = {Broken{"vertex 1 is not at a finite",
                               [](Scene& s) { s.meshes[0].positions[1].y = kNan; }},
                        Broken{"vertex 2 is not at a finite",
                               [](Scene& s) { s.meshes[0].positions[2].x = kInfinity; }},
                        Broken{"triangle 0 uses vertex 3 of 3",
                               [](Scene& s) { s.meshes[0].triangles[0].y = 3; }},
                        Broken{"mesh 't' names a material",
                               [](Scene& s) { s.meshes[0].material = MaterialId{1}; }},
                        Broken{"3 positions but 2 values",
                               [](Scene& s) { s.meshes[0].normals.resize(2); }},
                        Broken{"3 positions but 4 values",
                               [](Scene& s) { s.meshes[0].texcoords.resize(4); }},
                        Broken{"3 positions but 1 values",
                               [](Scene& s) { s.meshes[0].colours.resize(1); }},
                        Broken{"material 'm' names a texture",
                               [](Scene& s) { s.materials[0].reflectance_texture = TextureId{0}; }},
                        Broken{"material 'm' names a texture",
                               [](Scene& s) { s.materials[0].emission_texture = TextureId{7}; }},
                        Broken{"not a finite number",
                               [](Scene& s) { s.materials[0].reflectance.g = kNan; }},
                        Broken{"not a finite number",
                               [](Scene& s) { s.materials[0].opacity = kNan; }},
                        Broken{"not a finite number",
                               [](Scene& s) { s.materials[0].alpha_cutoff = kNan; }},
                        Broken{"texture 0 has no texels",
                               [](Scene& s) { s.textures.emplace_back(); }},
                        Broken{"is 2x2 but does not",
                               [](Scene& s) {
                                 s.textures.push_back(texture_of(2, 1, {0, 0}));
                                 s.textures[0].height = 2;
                               }},
                        Broken{"instance 0 names a mesh",
                               [](Scene& s) { s.instances[0].mesh = MeshId{1}; }},
                        Broken{"instance 0 names a mesh",
                               [](Scene& s) { s.instances[0].material = MaterialId{1}; }},
                        Broken{"transform that is not finite",
                               [](Scene& s) { s.instances[0].transform[3].x = kNan; }},
                        Broken{"transform that is not affine",
                               [](Scene& s) { s.instances[0].transform[0].w = 1.0f; }},
                        Broken{"camera 0 is not at a finite",
                               [](Scene& s) { s.cameras.emplace_back().eye.x = kNan; }},
                        Broken{"along its own up",
                               [](Scene& s) {
                                 s.cameras.emplace_back().up = {0, 0, 1};
                               }},
                        Broken{"along its own up",
                               [](Scene& s) { s.cameras.emplace_back().forward = Vec3(0); }},
                        Broken{"field of view",
                               [](Scene& s) { s.cameras.emplace_back().vertical_fov = 0; }},
                        Broken{"field of view",
                               [](Scene& s) { s.cameras.emplace_back().vertical_fov = kPi; }},
                        Broken{"field of view",
                               [](Scene& s) { s.cameras.emplace_back().vertical_fov = kNan; }},
                        Broken{"negative or not finite",
                               [](Scene& s) { s.lights.emplace_back().intensity.b = -1; }},
                        Broken{"no finite place",
                               [](Scene& s) { s.lights.emplace_back().position.x = kNan; }},
                        Broken{
                            "no finite place",
                            [](Scene& s) { s.lights.emplace_back().direction = Vec3(0); }},
                        Broken{
                            "cone",
                            [](Scene& s) {
                              s.lights.emplace_back().kind = PunctualKind::kSpot;
                              s.lights[0].outer_angle = kNan;
                            }},
                        Broken{"sky's radiance",
                               [](Scene& s) { s.sky = Sky{Rgb(-1), std::nullopt}; }},
                        Broken{"sky names a texture", [](Scene& s) {
                                 s.sky = Sky{Rgb(1), TextureId{0}};
                               }}};

TEST(Validate, NamesWhatIsWrongInOneLine) {
  for (const Broken& broken : kBroken) {
    SCOPED_TRACE(broken.message);
    Scene scene = one_triangle();
    broken.change(scene);
    try {
      validate(scene, "file");
      ADD_FAILURE() << "accepted";
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), ::testing::StartsWith("file: "));
      EXPECT_THAT(e.what(), HasSubstr(broken.message));
    }
  }
}

TEST(Validate, NamesTheFirstFewOfMany) {
  Scene scene = one_triangle();
  for (int i = 0; i < 6; ++i) scene.cameras.emplace_back().vertical_fov = 0;
  try {
    validate(scene, "file");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("camera 0 "));
    EXPECT_THAT(e.what(), HasSubstr("camera 3 "));
    EXPECT_THAT(e.what(), ::testing::Not(HasSubstr("camera 4 ")));
    EXPECT_THAT(e.what(), ::testing::EndsWith("; and 2 more"));
  }
}

TEST(Validate, RepairsWhatIsHarmlessAndSaysSo) {
  Scene scene = one_triangle();
  Mesh& mesh = scene.meshes[0];
  mesh.positions.push_back({2, 0, 0});
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 1, 2}};
  mesh.normals = {{0, 0, 1}, {0, kNan, 0}, {0, 0, 0}, {0, 0, 1}};
  mesh.texcoords = {{0, 0}, {kNan, 1}, {kInfinity, 0}, {1, 1}};
  scene.materials[0].reflectance = {1.5f, -0.5f, 0.5f};
  scene.materials[0].emission = {-1, kInfinity, 2};
  scene.materials[0].opacity = 3;
  const auto warnings = validate(scene, "f");
  EXPECT_THAT(mesh.triangles, ElementsAre(uvec3(0, 1, 2)));
  EXPECT_EQ(mesh.normals[1], Vec3(0));
  EXPECT_EQ(mesh.texcoords[1], Vec2(0));
  EXPECT_EQ(mesh.texcoords[2], Vec2(0));
  EXPECT_EQ(scene.materials[0].reflectance, Rgb(1, 0, 0.5f));
  EXPECT_EQ(scene.materials[0].emission, Rgb(0, 0, 2));
  EXPECT_EQ(scene.materials[0].opacity, 1.0f);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("reflectance brought into [0, 1]"),
                                    HasSubstr("emission is negative or not finite"),
                                    HasSubstr("2 triangles without area left out")));
}

TEST(Validate, OrdersTheConesOfSpots) {
  Scene scene = one_triangle();
  scene.lights.emplace_back().inner_angle = 2;
  scene.lights[0].outer_angle = 1;
  scene.lights.emplace_back().inner_angle = -1;
  scene.lights[1].outer_angle = 9;
  validate(scene, "f");
  EXPECT_EQ(scene.lights[0].inner_angle, 1.0f);
  EXPECT_EQ(scene.lights[1].inner_angle, 0.0f);
  EXPECT_EQ(scene.lights[1].outer_angle, kPi);
}

TEST(Validate, VertexColoursThatAreNotNumbersAreBlack) {
  Scene scene = one_triangle();
  scene.meshes[0].colours = {{1, 1, 1, 1}, {kNan, 1, 1, 1}, {1, 1, 1, kInfinity}};
  validate(scene, "f");
  EXPECT_EQ(scene.meshes[0].colours[0], Vec4(1));
  EXPECT_EQ(scene.meshes[0].colours[1], Vec4(0, 0, 0, 1));
  EXPECT_EQ(scene.meshes[0].colours[2], Vec4(0, 0, 0, 1));
}

TEST(Validate, TexelsThatCannotBeLightAreBlack) {
  Scene scene = one_triangle();
  scene.textures.push_back(texture_of(4, 1, {1, kInfinity, -2, kNan}));
  EXPECT_THAT(validate(scene, "f"), ElementsAre(HasSubstr("texture 0: 9 values")));
  const auto& values = scene.textures[0].linear;
  EXPECT_EQ(Vec4(values[0], values[4], values[8], values[12]), Vec4(1, 0, 0, 0));
}

TEST(Validate, KeepsSmallTriangles) {
  // A millimetre or a micrometre is small, not flat.
  for (const float size : {1e-3f, 1e-6f, 1e-8f}) {
    Scene scene = one_triangle();
    for (Vec3& p : scene.meshes[0].positions) p *= size;
    EXPECT_THAT(validate(scene, "f"), IsEmpty()) << size;
  }
}

// --- make_world()
// ----------------------------------------------------------------------------------

Vec3 unit_front(const World& world, std::uint32_t t) {
  return glm::normalize(world.area_vector(t));
}

TEST(MakeWorld, PlacesEveryInstance) {
  Scene scene = one_triangle();
  scene.materials.emplace_back();
  scene.instances.push_back({MeshId{0}, glm::translate(Mat4(1.0f), Vec3(5, 0, 0)), MaterialId{1}});
  const World world = make_world(scene);
  ASSERT_EQ(world.size(), 2u);
  EXPECT_EQ(world.triangles[1], uvec3(3, 4, 5));
  EXPECT_EQ(world.positions[4], Vec3(6, 0, 0));
  EXPECT_THAT(world.materials, ElementsAre(MaterialId{0}, MaterialId{1}));
  EXPECT_EQ(world.bounds.low, Vec3(0));
  EXPECT_EQ(world.bounds.high, Vec3(6, 1, 0));
  EXPECT_TRUE(world.normals.empty());
  EXPECT_FLOAT_EQ(world.area(1), 0.5f);
}

TEST(MakeWorld, AMirrorKeepsTheFront) {
  Scene scene = one_triangle();
  scene.meshes[0].normals.assign(3, {0, 0, 1});
  scene.meshes[0].texcoords = {{0, 0}, {1, 0}, {0, 1}};
  // Mirrored along x the front still faces +z; along z it comes to face -z.
  scene.instances[0].transform = glm::scale(Mat4(1.0f), Vec3(-1, 1, 1));
  World world = make_world(scene);
  EXPECT_EQ(unit_front(world, 0), Vec3(0, 0, 1));
  EXPECT_EQ(world.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(world.texcoords[1], Vec2(1, 0));
  EXPECT_EQ(world.positions[1], Vec3(-1, 0, 0));
  scene.instances[0].transform = glm::scale(Mat4(1.0f), Vec3(1, 1, -1));
  world = make_world(scene);
  EXPECT_EQ(unit_front(world, 0), Vec3(0, 0, -1));
  EXPECT_EQ(world.normals[0], Vec3(0, 0, -1));
}

TEST(MakeWorld, NormalsStayPerpendicularUnderShearAndScale) {
  Scene scene = one_triangle();
  // The triangle in the plane x = z, its normal (1, 0, -1) / sqrt(2) or the opposite.
  scene.meshes[0].positions = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};
  scene.meshes[0].normals.assign(3, glm::normalize(Vec3(-1, 0, 1)));
  Mat4 shear(1.0f);
  shear[2][0] = 3.0f;  // x += 3 z
  for (const Mat4& m : {shear, glm::scale(shear, Vec3(2, 1, 5)), glm::scale(shear, Vec3(-2, 1, 5)),
                        glm::scale(Mat4(1.0f), Vec3(1e-4f)), glm::scale(Mat4(1.0f), Vec3(1e-8f))}) {
    scene.instances[0].transform = m;
    const World world = make_world(scene);
    ASSERT_EQ(world.size(), 1u);
    EXPECT_NEAR(glm::length(world.normals[0]), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(world.normals[0], unit_front(world, 0)), 1.0f, 1e-5f);
  }
}

TEST(MakeWorld, DropsWhatATransformFlattens) {
  Scene scene = one_triangle();
  scene.instances[0].transform = glm::scale(Mat4(1.0f), Vec3(1, 0, 1));
  scene.instances.emplace_back();
  // Flat along z is still a triangle.
  scene.instances.push_back({MeshId{0}, glm::scale(Mat4(1.0f), Vec3(1, 1, 0)), std::nullopt});
  const World world = make_world(scene);
  EXPECT_EQ(world.size(), 2u);
  EXPECT_EQ(world.materials.size(), 2u);
}

TEST(MakeWorld, OptionalValuesOfOtherMeshesAreFilledUp) {
  Scene scene = one_triangle();
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes[1].normals.assign(3, {0, 0, 1});
  scene.meshes[1].colours.assign(3, {0.5f, 0.5f, 0.5f, 1});
  scene.instances.push_back({MeshId{1}, Mat4(1.0f), std::nullopt});
  const World world = make_world(scene);
  ASSERT_EQ(world.normals.size(), 6u);
  EXPECT_EQ(world.normals[0], Vec3(0));
  EXPECT_EQ(world.normals[3], Vec3(0, 0, 1));
  EXPECT_EQ(world.colours[0], Vec4(1));
  EXPECT_EQ(world.colours[3], Vec4(0.5f, 0.5f, 0.5f, 1));
  EXPECT_TRUE(world.texcoords.empty());
}

TEST(MakeWorld, BoundsAreThoseOfTheTriangles) {
  Scene scene = one_triangle();
  scene.meshes[0].positions.push_back({1e6f, 0, 0});  // of no triangle
  EXPECT_EQ(make_world(scene).bounds.high, Vec3(1, 1, 0));
}

TEST(MakeWorld, DropsTrianglesTooLargeForAnArea) {
  Scene scene = one_triangle();
  scene.instances[0].transform = glm::scale(Mat4(1.0f), Vec3(1e12f));
  EXPECT_EQ(make_world(scene).size(), 0u);
}

TEST(MakeWorld, ATransformBeyondAllNumbersIsAnError) {
  Scene scene = one_triangle();
  scene.meshes[0].positions[1].x = 1e30f;
  scene.instances[0].transform = glm::scale(Mat4(1.0f), Vec3(1e30f));
  EXPECT_THROW(make_world(scene), Error);
}

TEST(Subdivided, IsTheSameSurfaceInMoreTriangles) {
  Scene scene = one_triangle();
  Mesh& mesh = scene.meshes[0];
  mesh.positions.emplace_back(1, 1, 0.3f);  // a bent quad
  mesh.triangles.emplace_back(1, 3, 2);
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
  for (const Vec3& p : mesh.positions) mesh.texcoords.emplace_back(2.0f * p.x, 3.0f * p.y);
  const World world = make_world(scene);
  constexpr std::uint32_t kPieces = 7;
  const World finer = subdivided(world, kPieces);
  ASSERT_EQ(finer.size(), world.size() * kPieces * kPieces);
  EXPECT_EQ(finer.materials.size(), finer.size());
  EXPECT_EQ(finer.normals.size(), finer.positions.size());
  EXPECT_TRUE(finer.colours.empty());
  for (std::uint32_t t = 0; t < finer.size(); ++t) {
    const Vec3 whole = world.area_vector(t / (kPieces * kPieces));
    // As many pieces of the same size that face the same way; float rounding of the corners.
    EXPECT_NEAR(glm::length(finer.area_vector(t) * float{kPieces * kPieces} - whole), 0.0f, 1e-5f);
  }
  for (std::size_t v = 0; v < finer.positions.size(); ++v) {
    const Vec3 p = finer.positions[v];
    EXPECT_NEAR(finer.texcoords[v].x, 2.0f * p.x, 1e-6f);
    EXPECT_NEAR(finer.texcoords[v].y, 3.0f * p.y, 1e-6f);
  }
  // The diagonal's points are there twice, bit by bit the same; no two others are.
  std::size_t same = 0;
  for (std::size_t a = 0; a < finer.positions.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) same += finer.positions[a] == finer.positions[b] ? 1 : 0;
  }
  EXPECT_EQ(same, kPieces + 1);
}

TEST(Subdivided, InOnePieceIsTheSame) {
  const World world = make_world(one_triangle());
  const World same = subdivided(world, 1);
  ASSERT_EQ(same.size(), 1u);
  for (int corner = 0; corner < 3; ++corner) {
    EXPECT_EQ(same.positions[same.triangles[0][corner]],
              world.positions[world.triangles[0][corner]]);
  }
}

TEST(MakeWorld, NoInstancesAreAnEmptyWorld) {
  const World world = make_world(Scene{});
  EXPECT_EQ(world.size(), 0u);
  EXPECT_TRUE(world.bounds.empty());
}

// --- sample(), mean()
// ------------------------------------------------------------------------------

TEST(Sample, IsBilinearBetweenTexelCentres) {
  const Texture texture = texture_of(2, 2, {0, 1, 2, 3});
  EXPECT_EQ(sample(texture, {0.25f, 0.25f}).r, 0.0f);
  EXPECT_EQ(sample(texture, {0.75f, 0.25f}).r, 1.0f);
  EXPECT_EQ(sample(texture, {0.25f, 0.75f}).r, 2.0f);  // row 0 at v = 0
  EXPECT_EQ(sample(texture, {0.5f, 0.25f}).r, 0.5f);
  EXPECT_EQ(sample(texture, {0.5f, 0.5f}).r, 1.5f);
  EXPECT_EQ(sample(texture, {0.5f, 0.5f}).a, 1.0f);
}

TEST(Sample, WrapsAsTheTextureSays) {
  Texture texture = texture_of(4, 1, {0, 1, 2, 3});
  const auto at = [&](float u) { return sample(texture, {u, 0.5f}).r; };
  EXPECT_EQ(at(0.0f), 1.5f);  // half of the first and half of the last
  EXPECT_EQ(at(1.125f), 0.0f);
  EXPECT_EQ(at(-0.125f), 3.0f);
  EXPECT_EQ(at(7.375f), 1.0f);
  EXPECT_EQ(at(-6.875f), 0.0f);
  texture.wrap_u = Wrap::kClamp;
  EXPECT_EQ(at(0.0f), 0.0f);
  EXPECT_EQ(at(1.125f), 3.0f);
  EXPECT_EQ(at(-5.0f), 0.0f);
  EXPECT_EQ(at(1.0f), 3.0f);
  texture.wrap_u = Wrap::kMirror;
  EXPECT_EQ(at(0.0f), 0.0f);
  EXPECT_EQ(at(-0.125f), 0.0f);
  EXPECT_EQ(at(-0.375f), 1.0f);
  EXPECT_EQ(at(1.125f), 3.0f);
  EXPECT_EQ(at(1.875f), 0.0f);
  EXPECT_EQ(at(2.375f), 1.0f);
}

TEST(Sample, SurvivesAnyCoordinate) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    Texture texture = texture_of(4, 1, {1, 2, 3, 4});
    texture.wrap_u = texture.wrap_v = wrap;
    // Not finite counts as 0.
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      EXPECT_EQ(sample(texture, {bad, 0.5f}), sample(texture, {0.0f, 0.5f}));
      EXPECT_EQ(sample(texture, {0.375f, bad}), sample(texture, {0.375f, 0.0f}));
    }
    for (const float wild : {1e30f, -1e30f, 4096.0f, -4097.5f, 3e9f}) {
      const float r = sample(texture, {wild, wild}).r;
      EXPECT_GE(r, 1.0f);
      EXPECT_LE(r, 4.0f);
    }
  }
  // Beyond the edge is the edge, however far.
  Texture clamped = texture_of(4, 1, {1, 2, 3, 4});
  clamped.wrap_u = Wrap::kClamp;
  for (const float far : {4096.0f, 4096.25f, 1e9f, 1e30f}) {
    EXPECT_EQ(sample(clamped, {far, 0.5f}).r, 4.0f) << far;
    EXPECT_EQ(sample(clamped, {-far, 0.5f}).r, 1.0f) << -far;
  }
}

TEST(Sample, DecodesSrgbButNotAlpha) {
  Texture texture;
  texture.width = texture.height = 1;
  texture.srgb8 = {188, 0, 255, 51};
  const Vec4 c = sample(texture, {0.3f, 0.9f});
  EXPECT_NEAR(c.r, 0.50289f, 1e-5f);  // ((188/255 + 0.055) / 1.055)^2.4
  EXPECT_EQ(c.g, 0.0f);
  EXPECT_EQ(c.b, 1.0f);
  EXPECT_FLOAT_EQ(c.a, 0.2f);
  EXPECT_FLOAT_EQ(srgb8_to_linear(10), 10.0f / 255.0f / 12.92f);
}

TEST(Mean, IsTheMeanOfAllTexels) {
  EXPECT_EQ(mean(texture_of(2, 2, {0, 1, 2, 5})), Vec4(2, 2, 2, 1));
}

// --- surface_at(), emission_at(), is_hole(), mean_reflectivity()
// -----------------------------------

TEST(SurfaceAt, InterpolatesTheTriangle) {
  Scene scene = one_triangle();
  scene.meshes[0].texcoords = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}};
  scene.meshes[0].colours = {{1, 1, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};
  scene.textures.push_back(texture_of(2, 2, {0, 1, 0.5f, 1}));
  scene.materials[0].reflectance = Rgb(1, 0.5f, 0.25f);
  scene.materials[0].reflectance_texture = TextureId{0};
  const World world = make_world(scene);
  SurfacePoint point = surface_at(scene, world, 0, {0.5f, 0.0f});
  EXPECT_EQ(point.position, Vec3(0.5f, 0, 0));
  EXPECT_EQ(point.geometric_normal, Vec3(0, 0, 1));
  EXPECT_EQ(point.shading_normal, Vec3(0, 0, 1));
  EXPECT_EQ(point.reflectance, Rgb(0.5f, 0.25f, 0.125f));  // texture: between 0 and 1
  scene.materials[0].vertex_colours = true;
  point = surface_at(scene, world, 0, {0.5f, 0.0f});
  EXPECT_EQ(point.reflectance, Rgb(0.25f, 0.25f, 0.125f));
}

TEST(SurfaceAt, ReflectanceStaysInRange) {
  Scene scene = one_triangle();
  scene.textures.push_back(texture_of(1, 1, {40}));
  scene.materials[0].reflectance_texture = TextureId{0};
  scene.meshes[0].texcoords.resize(3);
  EXPECT_EQ(surface_at(scene, make_world(scene), 0, {0.2f, 0.2f}).reflectance, Rgb(1));
}

TEST(SurfaceAt, ShadingNormalsStayOnTheGeometricSide) {
  Scene scene = one_triangle();
  scene.meshes[0].normals = {{0, 0, -1}, {0, 0.6f, 0.8f}, {0, 0, 0}};
  const World world = make_world(scene);
  EXPECT_EQ(surface_at(scene, world, 0, {0, 0}).shading_normal, Vec3(0, 0, 1));
  EXPECT_EQ(surface_at(scene, world, 0, {1, 0}).shading_normal, Vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(surface_at(scene, world, 0, {0, 1}).shading_normal, Vec3(0, 0, 1));  // none given
}

TEST(SurfaceAt, TinyTrianglesHaveUnitNormals) {
  Scene scene = one_triangle();
  for (Vec3& p : scene.meshes[0].positions) p *= 1e-8f;
  validate(scene, "f");
  const World world = make_world(scene);
  ASSERT_EQ(world.size(), 1u);
  EXPECT_NEAR(glm::length(surface_at(scene, world, 0, {0.1f, 0.1f}).geometric_normal), 1, 1e-6f);
}

TEST(EmissionAt, LeavesTheFrontOrBothSides) {
  Scene scene = one_triangle();
  scene.materials[0].emission = Rgb(4, 2, 1);
  const World world = make_world(scene);
  EXPECT_EQ(emission_at(scene, world, 0, {0, 0}, true), Rgb(4, 2, 1));
  EXPECT_EQ(emission_at(scene, world, 0, {0, 0}, false), Rgb(0));
  scene.materials[0].double_sided = true;
  EXPECT_EQ(emission_at(scene, world, 0, {0, 0}, false), Rgb(4, 2, 1));
  scene.textures.push_back(texture_of(1, 1, {0.5f}));
  scene.materials[0].emission_texture = TextureId{0};
  EXPECT_EQ(emission_at(scene, world, 0, {0, 0}, true), Rgb(2, 1, 0.5f));
}

TEST(IsHole, ComparesOpacityWithTheCutoff) {
  Scene scene = one_triangle();
  scene.meshes[0].colours.assign(3, {1, 1, 1, 0.5f});
  Texture texture = texture_of(1, 1, {1});
  texture.linear[3] = 0.75f;
  scene.textures.push_back(texture);
  Material& material = scene.materials[0];
  const World world = make_world(scene);
  const auto hole = [&] { return is_hole(scene, world, 0, {0.2f, 0.2f}, Vec3(0.0f), Vec3(1.0f)); };
  material.opacity = 0.5f;
  EXPECT_FALSE(hole());  // no mask
  material.alpha_cutoff = 0.5f;
  EXPECT_FALSE(hole());  // not below
  material.reflectance_texture = TextureId{0};
  EXPECT_TRUE(hole());  // 0.375
  material.alpha_cutoff = 0.3f;
  EXPECT_FALSE(hole());
  material.vertex_colours = true;
  EXPECT_TRUE(hole());  // 0.1875
}

TEST(MeanReflectivity, IsWeightedByArea) {
  Scene scene = one_triangle();
  scene.materials[0].reflectance = Rgb(0.9f, 0.6f, 0.3f);  // 0.6 over 0.5 m²
  scene.materials.emplace_back().reflectance = Rgb(0.1f);  // 0.1 over 2 m²
  scene.instances.push_back({MeshId{0}, glm::scale(Mat4(1.0f), Vec3(2)), MaterialId{1}});
  EXPECT_NEAR(mean_reflectivity(scene, make_world(scene)), (0.3f + 0.2f) / 2.5f, 1e-6f);
}

TEST(MeanReflectivity, TakesTexturesAndVertexColoursIn) {
  Scene scene = one_triangle();
  scene.meshes[0].texcoords.resize(3);
  scene.meshes[0].colours = {{1, 1, 1, 1}, {0.5f, 0.5f, 0.5f, 1}, {0, 0, 0, 1}};
  scene.textures.push_back(texture_of(2, 1, {0.2f, 0.6f}));
  scene.materials[0].reflectance = Rgb(1);
  scene.materials[0].reflectance_texture = TextureId{0};
  EXPECT_NEAR(mean_reflectivity(scene, make_world(scene)), 0.4f, 1e-6f);
  scene.materials[0].vertex_colours = true;
  EXPECT_NEAR(mean_reflectivity(scene, make_world(scene)), 0.2f, 1e-6f);
}

TEST(MeanReflectivity, OfNothingIsZero) { EXPECT_EQ(mean_reflectivity(Scene{}, World{}), 0.0f); }

}  // namespace
}  // namespace lantern
