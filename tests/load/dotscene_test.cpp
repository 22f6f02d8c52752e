// SPDX-License-Identifier: MIT
#include "lantern/load/dotscene.h"

#include "lantern/core/file.h"

#include "tests/load/ogre_files.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>

namespace lantern {
namespace {

using test::BinaryMesh;
using test::error_of;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::string_view kMesh =
    "<mesh><submeshes>"
    "<submesh material='a' usesharedvertices='true'><faces><face v1='0' v2='1' "
    "v3='2'/></faces></submesh>"
    "<submesh material='b' usesharedvertices='true'><faces><face v1='2' v2='1' "
    "v3='0'/></faces></submesh>"
    "</submeshes><sharedgeometry vertexcount='3'><vertexbuffer positions='true'>"
    "<vertex><position x='0' y='0' z='0'/></vertex><vertex><position x='1' y='0' z='0'/></vertex>"
    "<vertex><position x='0' y='1' z='0'/></vertex></vertexbuffer></sharedgeometry></mesh>";

struct Parsed {
  ogre::DotScene scene;
  LoadReport report;
};

Parsed parse(const std::string& nodes) {
  Parsed parsed;
  parsed.scene = ogre::parse_dotscene("<scene formatVersion='1.1'>\n" + nodes + "</scene>",
                                      "test.scene", parsed.report);
  return parsed;
}

std::string error(const std::string& nodes) {
  return error_of([&] { parse(nodes); });
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

Vec3 moved(const std::string& node, const Vec3& point) {
  const Parsed parsed = parse("<nodes><node>" + node + "<entity meshFile='x'/></node></nodes>");
  return Vec3(parsed.scene.entities.at(0).transform * Vec4(point, 1));
}

TEST(DotScene, RotationsOfAllSpellings) {
  const Vec3 x(1, 0, 0);
  for (const char* quarter_about_y :
       {"<rotation qw='0.70710678' qx='0' qy='0.70710678' qz='0'/>",
        "<quaternion w='1' x='0' y='1' z='0'/>",
        "<rotation angle='1.57079633' axisX='0' axisY='3' axisZ='0'/>",
        "<rotation angleX='0' angleY='90' angleZ='0'/>"}) {
    expect_near(moved(quarter_about_y, x), {0, 0, -1});
  }
  EXPECT_THAT(error("<node><rotation qw='0' qx='0' qy='0' qz='0'/></node>"),
              HasSubstr("<rotation> has no direction"));
}

TEST(DotScene, NestedNodesMultiplyTheirTransforms) {
  const Parsed parsed = parse(
      "<nodes><position x='100' y='0' z='0'/><node><position x='1' y='2' z='3'/><scale x='2' y='2' "
      "z='2'/><node><position x='1' y='0' z='0'/><rotation qw='0' qx='0' qy='1' qz='0'/><entity "
      "meshFile='x'/></node></node></nodes>");
  expect_near(Vec3(parsed.scene.entities.at(0).transform * Vec4(1, 0, 0, 1)), {101, 2, 3});
}

TEST(DotScene, Cameras) {
  const Parsed parsed = parse(
      "<nodes><node><position x='2.78' y='2.73' z='-8'/><rotation qw='0' qx='0' qy='1' qz='0'/>"
      "<camera name='c' fov='39.3076'><clipping near='1' far='2'/></camera></node>"
      "<node><camera name='d' fov='0.5'/></node><node><camera/><lookTarget/></node></nodes>");
  ASSERT_EQ(parsed.scene.cameras.size(), 3u);
  const Camera& camera = parsed.scene.cameras[0];
  EXPECT_EQ(camera.name, "c");
  expect_near(camera.eye, {2.78f, 2.73f, -8});
  expect_near(camera.forward, {0, 0, 1});
  expect_near(camera.up, {0, 1, 0});
  EXPECT_FLOAT_EQ(camera.vertical_fov, glm::radians(39.3076f));
  EXPECT_FLOAT_EQ(parsed.scene.cameras[1].vertical_fov, 0.5f);
  EXPECT_FLOAT_EQ(parsed.scene.cameras[2].vertical_fov, glm::radians(45.0f));
  EXPECT_EQ(parsed.report.unknown, (std::map<std::string, int>{{"scene: lookTarget", 1}}));
  EXPECT_EQ(parsed.report.format, "DotScene 1.1");
}

TEST(DotScene, Lights) {
  const Parsed parsed = parse(
      "<nodes><node><position x='1' y='2' z='3'/><light name='p' type='point' power='10'>"
      "<colourDiffuse r='1' g='0.5' b='0'/><lightAttenuation range='5' constant='1' linear='0' "
      "quadratic='0'/></light></node>"
      "<node><rotation angle='-1.57079633' axisX='1' axisY='0' axisZ='0'/>"
      "<light type='spot' powerScale='2'><lightRange inner='30' outer='40' falloff='1'/></light>"
      "<light type='directional'><colourDiffuse r='3' g='3' b='3'/></light></node>"
      "<node><light type='point' visible='false'/><light type='rect'/></node></nodes>");
  const auto& lights = parsed.scene.lights;
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].kind, PunctualKind::kPoint);
  EXPECT_EQ(lights[0].intensity, Rgb(10, 5, 0));
  EXPECT_EQ(lights[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(lights[1].kind, PunctualKind::kSpot);
  EXPECT_EQ(lights[1].intensity, Rgb(2));
  expect_near(lights[1].direction, {0, -1, 0});
  EXPECT_FLOAT_EQ(lights[1].inner_angle, glm::radians(15.0f));
  EXPECT_FLOAT_EQ(lights[1].outer_angle, glm::radians(20.0f));
  EXPECT_EQ(lights[2].kind, PunctualKind::kDirectional);
  EXPECT_EQ(lights[2].intensity, Rgb(3));
  EXPECT_EQ(parsed.report.unknown, (std::map<std::string, int>{{"scene: light of type rect", 1}}));
}

TEST(DotScene, TheSkyIsTheAmbientColourOrElseTheBackground) {
  const std::string ambient = "<colourAmbient r='0.1' g='0.2' b='0.3'/>";
  const std::string black = "<colourAmbient r='0' g='0' b='0'/>";
  const std::string background = "<colourBackground r='1' g='1' b='1'/>";
  const auto environment = [](const std::string& e) {
    return parse("<environment>" + e + "</environment>");
  };
  EXPECT_EQ(environment(ambient).scene.sky->radiance, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(environment(background).scene.sky->radiance, Rgb(1));
  EXPECT_FALSE(environment(black + background).scene.sky);
  EXPECT_EQ(environment(background + ambient).scene.sky->radiance, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(environment(background + ambient).report.unknown.at("scene: colourBackground"), 1);
  EXPECT_FALSE(environment("").scene.sky);
}

TEST(DotScene, ErrorsNameTheLine) {
  EXPECT_EQ(
      error("<node><position x='nan' y='0' z='0'/></node>\n<node><entity/></node>"),
      "test.scene:2: x=\"nan\" is no finite number; test.scene:3: the entity has no meshFile");
  EXPECT_THAT(error("<node><camera fov='1e999'/></node>"), StartsWith("test.scene:2: "));
  EXPECT_THAT(error("<node>"), HasSubstr("XML_ERROR_MISMATCHED_ELEMENT"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<node>";
  EXPECT_THAT(error(deep), HasSubstr("nest deeper than 100"));
}

class DotSceneFiles : public ::testing::Test {
 protected:
  Loaded load(const std::string& nodes) {
    write_file(folder_ / "test.scene", "<scene><nodes>\n" + nodes + "</nodes></scene>");
    return load_dotscene(folder_ / "test.scene", {});
  }
  TemporaryFolder folder_;
};

TEST_F(DotSceneFiles, MeshesAreFoundAndReadOnce) {
  std::filesystem::create_directory(folder_ / "models");
  std::filesystem::create_directory(folder_ / "materials");
  write_file(folder_ / "models" / "two.mesh.xml", kMesh);
  write_file(folder_ / "one.mesh", BinaryMesh{}.write());
  write_file(folder_ / "models" / "two.material", "material a { }\nmaterial b { }");
  write_file(folder_ / "materials" / "stone.material", "material stone { }\nmaterial c { }");
  const Loaded loaded = load(
      "<node><entity meshFile='two.mesh'/></node><node><entity meshFile='one.mesh'/></node>"
      "<node><entity meshFile='two.mesh.xml'><subentities><subentity index='1' materialName='c'/>"
      "</subentities></entity></node><node><entity meshFile='one.mesh' materialFile='c'/></node>"
      "<node><entity meshFile='one.mesh' visible='false'/></node>");
  const Scene& scene = loaded.scene;
  EXPECT_EQ(scene.meshes.size(), 3u);
  ASSERT_EQ(scene.instances.size(), 6u);
  EXPECT_EQ(scene.instances[3].mesh, scene.instances[0].mesh);
  EXPECT_FALSE(scene.instances[3].material);
  const auto material_of = [&](std::size_t i) {
    return scene.materials[index(*scene.instances[i].material)].name;
  };
  EXPECT_EQ(material_of(4), "c");
  EXPECT_EQ(material_of(5), "c");
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  EXPECT_THAT(names, ElementsAre("a", "b", "stone", "c"));
  EXPECT_TRUE(loaded.report.warnings.empty()) << loaded.report.warnings[0];
  EXPECT_EQ(loaded.report.format, "DotScene");
}

TEST_F(DotSceneFiles, AMissingOrBrokenMeshIsAnErrorWithItsPlace) {
  EXPECT_THAT(error_of([&] { load("\n<node><entity meshFile='gone.mesh'/></node>"); }),
              HasSubstr("test.scene:3: mesh 'gone.mesh' was not found"));
  write_file(folder_ / "bad.mesh", "nothing");
  EXPECT_THAT(error_of([&] { load("<node><entity meshFile='bad.mesh'/></node>"); }),
              HasSubstr("bad.mesh: byte 0: is no Ogre mesh"));
}

}  // namespace
}  // namespace lantern
