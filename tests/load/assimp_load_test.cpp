// SPDX-License-Identifier: MIT
#include "tests/load/load_files.h"

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <cmath>
#include <functional>
#include <memory>

namespace lantern::test {
namespace {

using AssimpTest = LoadTest;

constexpr const char* kObj = R"(mtllib a.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
vt 0 0
vt 1 0
vt 0 .25
usemtl red
f 1/1 2/2 3/3
g two
usemtl lamp
f 1 2 4 3
l 1 2
)";

constexpr const char* kMtl = R"(newmtl red
Kd .5 .25 .125
Ks .1 .2 .3
Ns 20
map_Kd -clamp on t.png
d .5

newmtl lamp
Ke 50 40 30
map_Ke t.png
)";

TEST_F(AssimpTest, CutsPolygonsIntoTriangles) {
  const Loaded loaded = load("a.obj",
                             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 .5 0\n"
                             "f 1 2 3 4\nf 1 2 3 4 5\nf 1 2 3\n");
  std::size_t triangles = 0;
  for (const Mesh& mesh : loaded.scene.meshes) triangles += mesh.triangles.size();
  EXPECT_EQ(triangles, 2u + 3u + 1u);
  EXPECT_TRUE(loaded.report.warnings.empty());
}

TEST_F(AssimpTest, ReadsObjAndMtl) {
  write("a.mtl", kMtl);
  write("t.png", from_base64(kPng64));
  const Loaded loaded = load("a.obj", kObj);
  const Scene& scene = loaded.scene;
  EXPECT_THAT(loaded.report.format, ::testing::HasSubstr("Wavefront"));
  EXPECT_THAT(loaded.report.warnings, ::testing::ElementsAre("1 points and lines left out"));
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.instances.size(), 2u);

  const Mesh& red = scene.meshes[0];
  EXPECT_EQ(red.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  // v points up in OBJ: the first row is at v = 1.
  EXPECT_EQ(red.texcoords, (std::vector<Vec2>{{0, 1}, {1, 1}, {0, 0.75f}}));
  EXPECT_TRUE(red.normals.empty());
  EXPECT_EQ(scene.meshes[1].triangles.size(), 2u);

  const Material& material = scene.materials.at(index(red.material));
  EXPECT_EQ(material.name, "red");
  EXPECT_EQ(material.reflectance, Rgb(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(material.specular, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material.shininess, 20.0f);
  EXPECT_EQ(material.opacity, 0.5f);
  EXPECT_EQ(material.emission, Rgb(0));
  const Texture& clamped = scene.textures.at(index(material.reflectance_texture.value()));
  EXPECT_EQ(clamped.wrap_u, Wrap::kClamp);
  EXPECT_EQ(clamped.srgb8.at(0), 255);

  const Material& lamp = scene.materials.at(index(scene.meshes[1].material));
  EXPECT_EQ(lamp.emission, Rgb(50, 40, 30));
  EXPECT_EQ(scene.textures.at(index(lamp.emission_texture.value())).wrap_u, Wrap::kRepeat);
}

TEST_F(AssimpTest, NumbersMayStartWithTheirPoint) {
  const Loaded loaded = load("a.obj", "v .5 -.5 0\nv\t1 .0 0\nv 0 1 .25\nf 1 2 3\n");
  EXPECT_EQ(loaded.scene.meshes.at(0).positions,
            (std::vector<Vec3>{{0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0.25f}}));
}

TEST_F(AssimpTest, ReadsVertexColours) {
  const Loaded loaded = load("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 .5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_EQ(mesh.colours, (std::vector<Vec4>{{1, 0, 0, 1}, {0, 0.5f, 0, 1}, {0, 0, 1, 1}}));
  EXPECT_TRUE(loaded.scene.materials.at(index(mesh.material)).vertex_colours);
}

TEST_F(AssimpTest, MissingMaterialsAndPicturesAreRepaired) {
  EXPECT_EQ(load("a.obj", kObj).scene.instances.size(), 2u);  // no a.mtl
  write("a.mtl", kMtl);
  const Loaded loaded = load("a.obj", kObj);  // no t.png
  EXPECT_THAT(loaded.report.warnings, ::testing::Contains(::testing::HasSubstr("t.png")));
  write("t.png", "this is no picture");
  EXPECT_THAT(error_of(folder / "a.obj"), ::testing::HasSubstr("t.png"));
}

TEST_F(AssimpTest, ADeviceIsNoMaterialFile) {
  const Loaded loaded = load("a.obj", "mtllib /dev/zero\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(loaded.scene.instances.size(), 1u);
}

TEST_F(AssimpTest, ReadsPly) {
  const Loaded loaded = load("a.ply", R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 0 51 0
0 1 0 0 0 255
3 0 1 2
)");
  EXPECT_EQ(loaded.scene.meshes.at(0).colours.at(1), Vec4(0, 0.2f, 0, 1));
}

TEST_F(AssimpTest, ReadsStl) {
  const Loaded loaded = load("a.stl", R"(solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid a
)");
  EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(2), Vec3(0, 1, 0));
  EXPECT_EQ(loaded.scene.meshes.at(0).normals.at(2), Vec3(0, 0, 1));
}

constexpr const char* kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_cameras>
 <camera id="cam"><optics><technique_common><perspective>
  <xfov>90</xfov><aspect_ratio>2</aspect_ratio><znear>0.1</znear><zfar>10</zfar>
 </perspective></technique_common></optics></camera>
</library_cameras>
<library_lights>
 <light id="bulb"><technique_common><point><color>4 2 1</color></point></technique_common></light>
 <light id="beam"><technique_common><spot><color>1 1 1</color><falloff_angle>60</falloff_angle>
  <falloff_exponent>0</falloff_exponent></spot></technique_common></light>
 <light id="sun"><technique_common><directional><color>3 3 3</color></directional>
 </technique_common></light>
 <light id="dim"><technique_common><ambient><color>1 1 1</color></ambient></technique_common></light>
</library_lights>
<library_geometries><geometry id="tri"><mesh>
 <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
  <technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
  <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
 <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
 <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
 <node id="a" name="a"><instance_geometry url="#tri"/></node>
 <node id="b" name="b"><translate>0 0 7</translate><instance_geometry url="#tri"/></node>
 <node id="c" name="c"><translate>0 1 5</translate><rotate>0 1 0 90</rotate>
  <instance_camera url="#cam"/></node>
 <node id="l" name="l"><translate>0 3 0</translate><instance_light url="#bulb"/></node>
 <node id="m" name="m"><rotate>1 0 0 -90</rotate><instance_light url="#beam"/></node>
 <node id="n" name="n"><rotate>1 0 0 -90</rotate><instance_light url="#sun"/></node>
 <node id="o" name="o"><instance_light url="#dim"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";

TEST_F(AssimpTest, ReadsInstancesCamerasAndLightsOfCollada) {
  const Loaded loaded = load("a.dae", kCollada);
  const Scene& scene = loaded.scene;
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(Vec3(scene.instances[1].transform[3]), Vec3(0, 0, 7));

  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.eye, Vec3(0, 1, 5));
  EXPECT_NEAR(camera.forward.x, -1.0f, 1e-6f);
  EXPECT_NEAR(camera.up.y, 1.0f, 1e-6f);
  // assimp 5.2 does not find the optics.
  EXPECT_EQ(camera.vertical_fov, Camera().vertical_fov);
  EXPECT_THAT(loaded.report.warnings, ::testing::ElementsAre(::testing::HasSubstr("camera 'c'")));

  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, PunctualKind::kPoint);
  EXPECT_EQ(scene.lights[0].position, Vec3(0, 3, 0));
  EXPECT_EQ(scene.lights[0].intensity, Rgb(4, 2, 1));
  EXPECT_EQ(scene.lights[1].kind, PunctualKind::kSpot);
  EXPECT_NEAR(scene.lights[1].direction.y, -1.0f, 1e-6f);
  EXPECT_NEAR(scene.lights[1].inner_angle, kPi / 6, 1e-6f);
  EXPECT_EQ(scene.lights[2].kind, PunctualKind::kDirectional);
  EXPECT_EQ(scene.lights[2].intensity, Rgb(3));
  EXPECT_EQ(loaded.report.unknown.at("ambient or area light"), 1);
}

/// A scene in assimp's own format, for what no short text file of another one can say.
std::filesystem::path write_assbin(const std::filesystem::path& path,
                                   const std::function<void(aiScene&)>& change) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  Assimp::Importer importer;
  importer.ReadFileFromMemory(obj.data(), obj.size(), 0, "obj");
  const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
  change(*scene);
  Assimp::Exporter exporter;
  EXPECT_EQ(exporter.Export(scene.get(), "assbin", path.string()), aiReturn_SUCCESS);
  return path;
}

TEST_F(AssimpTest, AHorizontalFieldOfViewBecomesVertical) {
  const auto path = write_assbin(folder / "a.assbin", [](aiScene& scene) {
    scene.mNumCameras = 2;
    scene.mCameras = new aiCamera* [2] { new aiCamera, new aiCamera };
    for (unsigned i = 0; i < 2; ++i) {
      scene.mCameras[i]->mName = scene.mRootNode->mName;
      scene.mCameras[i]->mHorizontalFOV = kPi / 2;
      scene.mCameras[i]->mPosition = {1, 2, 3};
    }
    scene.mCameras[1]->mAspect = 2;
    scene.mRootNode->mTransformation.a4 = 10;
  });
  const Scene scene = load_scene(path).scene;
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_NEAR(scene.cameras[0].vertical_fov, kPi / 2, 1e-6f);
  // tan(90°/2) = 1 across, half of it up.
  EXPECT_NEAR(scene.cameras[1].vertical_fov, 2.0f * std::atan(0.5f), 1e-6f);
  EXPECT_EQ(scene.cameras[1].eye, Vec3(11, 2, 3));
  EXPECT_EQ(scene.cameras[1].forward, Vec3(0, 0, 1));
}

TEST_F(AssimpTest, AnimationAloneHasNoTriangles) {
  EXPECT_THAT(error_of("a.bvh", R"(HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 3 Xposition Yposition Zposition
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
Frames: 1
Frame Time: 0.1
0 0 0
)"),
              ::testing::HasSubstr("has no triangles"));
}

// --- Broken files
// ----------------------------------------------------------------------------------

TEST_F(AssimpTest, BrokenObjEndsInOneLineWithThePath) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string& text :
       {std::string(), std::string("hello\n"), corners, corners + "f 1 2 99\n",
        corners + "f -1 -2 -9\n", corners + "f 0 1 2\n", corners + "f 1 2\n",
        "v 0 nan 0\n" + corners + "f 1 2 3\n", "v inf 0 0\n" + corners + "f 1 2 3\n",
        "v 1e999 0 0\n" + corners + "f 1 2 3\n", corners + "f 1 1 1\n", std::string(100, '\0'),
        std::string(5000, 'v')}) {
    EXPECT_THAT(error_of("a.obj", text), ::testing::HasSubstr("a.obj: ")) << text;
  }
}

TEST_F(AssimpTest, TextureCoordinatesOutOfRangeAreDropped) {
  const Loaded loaded = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/7 2/8 3/9\n");
  EXPECT_EQ(loaded.scene.meshes.at(0).triangles.size(), 1u);
}

TEST_F(AssimpTest, TruncatedFilesEndInASceneOrAnError) {
  write("a.mtl", kMtl);
  write("t.png", from_base64(kPng64));
  std::string obj;
  for (int i = 0; i < 20; ++i) obj += kObj;
  expect_survives_truncation("a.obj", obj);
  expect_survives_truncation("a.dae", kCollada);
}

}  // namespace
}  // namespace lantern::test
