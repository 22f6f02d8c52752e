// SPDX-License-Identifier: MIT
#include "tests/load/load_files.h"

namespace lantern::test {
namespace {

using DispatchTest = LoadTest;

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(DispatchTest, TheNameDecides) {
  EXPECT_EQ(load("a.gltf", Gltf().text()).report.format, "glTF 2.0");
  EXPECT_EQ(load("a.GLB", Gltf().glb()).report.format, "glTF 2.0, binary");
  EXPECT_EQ(load("a.OBJ", kObj).scene.meshes.size(), 1u);
}

TEST_F(DispatchTest, XmlIsOgres) {
  constexpr const char* kMesh = R"(<mesh><submeshes>
    <submesh usesharedvertices="false" use32bitindexes="false" operationtype="triangle_list">
    <faces count="1"><face v1="0" v2="1" v3="2"/></faces>
    <geometry vertexcount="3"><vertexbuffer positions="true">
    <vertex><position x="0" y="0" z="0"/></vertex><vertex><position x="1" y="0" z="0"/></vertex>
    <vertex><position x="0" y="1" z="0"/></vertex></vertexbuffer></geometry></submesh>
    </submeshes></mesh>)";
  for (const char* name : {"a.mesh.xml", "a.xml", "a.Mesh.XML"}) {
    EXPECT_THAT(load(name, kMesh).report.format, ::testing::HasSubstr("Ogre")) << name;
  }
}

TEST_F(DispatchTest, MeshAndSceneAreOgres) {
  // Neither goes to assimp, which reads both formats in its own way.
  EXPECT_NE(error_of("a.mesh", "hello"), "");
  EXPECT_THAT(error_of("a.scene", "<scene formatVersion='1.0'></scene>"),
              ::testing::HasSubstr("has no triangles"));
}

TEST_F(DispatchTest, UnknownFormatsAreOneError) {
  EXPECT_THAT(error_of("a.strange", "hello"),
              ::testing::HasSubstr("a.strange: its format is unknown"));
  EXPECT_THAT(error_of("noextension", "hello"), ::testing::HasSubstr("its format is unknown"));
}

TEST_F(DispatchTest, MissingFilesAndFoldersAreErrors) {
  for (const char* name : {"a.gltf", "a.glb", "a.obj", "a.strange", "a"}) {
    EXPECT_THAT(error_of(folder / name), ::testing::EndsWith("no such file"));
  }
  EXPECT_THAT(error_of(folder.path()), ::testing::HasSubstr("is not a file"));
  EXPECT_THAT(error_of("/dev/zero"), ::testing::HasSubstr("is not a file"));
}

TEST_F(DispatchTest, TheUnitScalesLengthsAndKeepsThePicture) {
  Gltf gltf;
  gltf.json["nodes"] = Json::parse(R"([
    {"mesh": 0, "translation": [1, 2, 3], "scale": [5, 5, 5]},
    {"camera": 0, "translation": [10, 0, 0],
     "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"translation": [0, 10, 0], "extensions": {"KHR_lights_punctual": {"light": 1}}}])");
  gltf.json["scenes"][0]["nodes"] = {0, 1, 2};
  gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}}}}};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(
      R"([{"type": "point", "intensity": 8}, {"type": "directional", "intensity": 8}])");
  LoadOptions options;
  options.unit = 0.5f;
  const Scene scene = load("a.gltf", gltf.text(), options).scene;
  // Half as large around the origin: the mesh by its positions, its place by the translation.
  EXPECT_EQ(scene.meshes.at(0).positions.at(1), Vec3(0.5f, 0, 0));
  EXPECT_EQ(Vec3(scene.instances.at(0).transform * Vec4(0.5f, 0, 0, 1)), Vec3(3, 1, 1.5f));
  EXPECT_EQ(scene.cameras.at(0).eye, Vec3(5, 0, 0));
  EXPECT_EQ(scene.cameras.at(0).vertical_fov, 0.8f);
  EXPECT_EQ(scene.lights.at(0).position, Vec3(5, 0, 0));
  // I / d² stays: half the distance, a quarter of the intensity.
  EXPECT_EQ(scene.lights[0].intensity, Rgb(2));
  EXPECT_EQ(scene.lights.at(1).intensity, Rgb(8));
}

TEST_F(DispatchTest, AUnitMustBeALength) {
  const auto path = write("a.obj", kObj);
  for (const float unit : {0.0f, -1.0f, std::nanf(""), kInfinity}) {
    LoadOptions options;
    options.unit = unit;
    EXPECT_THROW(load_scene(path, options), Error) << unit;
  }
}

TEST_F(DispatchTest, WarningsOfTheCheckJoinTheReport) {
  const Loaded loaded = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
  EXPECT_THAT(loaded.report.warnings,
              ::testing::ElementsAre(::testing::HasSubstr("1 triangles without area")));
  EXPECT_EQ(loaded.scene.meshes.at(0).triangles.size(), 1u);
}

TEST_F(DispatchTest, NothingButFlatTrianglesIsNoScene) {
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
              ::testing::HasSubstr("a.obj: has no triangles"));
}

TEST(LoadReport, WarnsOnceOfEachThing) {
  LoadReport report;
  report.warn("a");
  report.warn("b");
  report.warn("a");
  EXPECT_THAT(report.warnings, ::testing::ElementsAre("a", "b"));
}

}  // namespace
}  // namespace lantern::test
