// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_xml.h"

#include "tests/load/ogre_files.h"

#include <fmt/format.h>

namespace lantern {
namespace {

using test::assemble;
using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A mesh of one submesh with `count` vertices at (i, 0, 0).
std::string one_submesh(int count, const std::string& operation, const std::string& faces,
                        const std::string& extra = "") {
  std::string text = fmt::format(
      "<mesh><submeshes><submesh material='stone' usesharedvertices='false' "
      "use32bitindexes='false' operationtype='{}'>\n<faces>{}</faces>\n<geometry "
      "vertexcount='{}'><vertexbuffer positions='true'>\n",
      operation, faces, count);
  for (int i = 0; i < count; ++i) {
    text += fmt::format("<vertex><position x='{}' y='0' z='0'/></vertex>\n", i);
  }
  return text + "</vertexbuffer></geometry>" + extra + "</submesh></submeshes></mesh>";
}

Loaded load(const std::string& text) {
  LoadReport report;
  const ogre::MeshFile file = ogre::parse_xml(text, "test.mesh.xml", report);
  Loaded loaded = assemble(file, "material stone { }");
  for (const auto& [name, count] : report.unknown) loaded.report.unknown[name] += count;
  loaded.report.format = report.format;
  return loaded;
}

std::string error(const std::string& text) {
  return error_of([&] { load(text); });
}

const std::string kFace = "<face v1='0' v2='1' v3='2'/>";

TEST(OgreXml, Triangles) {
  const Loaded loaded =
      load(one_submesh(4, "triangle_list", kFace + "<face v1='2' v2='1' v3='3'/>"));
  ASSERT_EQ(loaded.scene.meshes.size(), 1u);
  const Mesh& mesh = loaded.scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_THAT(mesh.triangles, ElementsAre(uvec3(0, 1, 2), uvec3(2, 1, 3)));
  EXPECT_EQ(loaded.scene.materials[index(mesh.material)].name, "stone");
  EXPECT_EQ(loaded.scene.instances.size(), 1u);
  EXPECT_EQ(loaded.report.format, "Ogre mesh XML");
  EXPECT_TRUE(loaded.report.warnings.empty());
  EXPECT_TRUE(loaded.report.unknown.empty());
}

TEST(OgreXml, StripsKeepTheirOrientationAndLeaveStitchesOut) {
  const Loaded plain =
      load(one_submesh(5, "triangle_strip", kFace + "<face v1='3'/><face v1='4'/>"));
  EXPECT_THAT(plain.scene.meshes[0].triangles,
              ElementsAre(uvec3(0, 1, 2), uvec3(2, 1, 3), uvec3(2, 3, 4)));
  // 0 1 2 | 2 3 | 3 4 5: four triangles without area join two of one orientation each.
  const Loaded stitched = load(one_submesh(
      6, "triangle_strip",
      kFace + "<face v1='2'/><face v1='3'/><face v1='3'/><face v1='4'/><face v1='5'/>"));
  EXPECT_THAT(stitched.scene.meshes[0].triangles, ElementsAre(uvec3(0, 1, 2), uvec3(4, 3, 5)));
}

TEST(OgreXml, Fans) {
  const Loaded loaded =
      load(one_submesh(5, "triangle_fan", kFace + "<face v1='3'/><face v1='4'/>"));
  EXPECT_THAT(loaded.scene.meshes[0].triangles,
              ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3), uvec3(0, 3, 4)));
}

TEST(OgreXml, PointsAndLinesAreCountedAndLeftOut) {
  const Loaded loaded = load(one_submesh(2, "line_list", "<face v1='0' v2='1'/>"));
  EXPECT_TRUE(loaded.scene.meshes.empty());
  EXPECT_TRUE(loaded.scene.instances.empty());
  EXPECT_EQ(loaded.report.unknown.at("mesh: line_list"), 1);
}

TEST(OgreXml, WithoutFacesTheVerticesFormTriangles) {
  const Loaded loaded = load(one_submesh(6, "triangle_list", ""));
  EXPECT_THAT(loaded.scene.meshes[0].triangles, ElementsAre(uvec3(0, 1, 2), uvec3(3, 4, 5)));
}

TEST(OgreXml, SharedGeometryIsCompactedInItsOrder) {
  const Loaded loaded = load(R"(<?xml version="1.0"?>
<mesh>
  <submeshes>
    <submesh material="a" usesharedvertices="true" operationtype="triangle_list">
      <faces count="1"><face v1="4" v2="2" v3="1"/></faces>
    </submesh>
    <submesh material="b">
      <faces count="1"><face v1="0" v2="1" v3="3"/></faces>
    </submesh>
  </submeshes>
  <sharedgeometry vertexcount="5">
    <vertexbuffer positions="true">
      <vertex><position x="0" y="0" z="0"/></vertex>
      <vertex><position x="1" y="0" z="0"/></vertex>
      <vertex><position x="2" y="0" z="0"/></vertex>
      <vertex><position x="3" y="0" z="0"/></vertex>
      <vertex><position x="4" y="0" z="0"/></vertex>
    </vertexbuffer>
    <vertexbuffer normals="true" colours_diffuse="true" texture_coords="2"
                  texture_coord_dimensions_0="float2" texture_coord_dimensions_1="2">
      <vertex><normal x="0" y="0" z="1"/><colour_diffuse value="0 0.5 1 0.25"/><texcoord u="0" v="1"/><texcoord u="9" v="9"/></vertex>
      <vertex><normal x="0" y="1" z="0"/><colour_diffuse value="1 1 1"/><texcoord u="0.1" v="1"/><texcoord u="9" v="9"/></vertex>
      <vertex><normal x="1" y="0" z="0"/><colour_diffuse value="2 0 0 1"/><texcoord u="0.2" v="1"/><texcoord u="9" v="9"/></vertex>
      <vertex><normal x="0" y="0" z="1"/><colour_diffuse value="0 0 0 1"/><texcoord u="0.3" v="1"/><texcoord u="9" v="9"/></vertex>
      <vertex><normal x="0" y="0" z="-1"/><colour_diffuse value="0 0 1 1"/><texcoord u="+4e-1" v="1"/><texcoord u="9" v="9"/></vertex>
    </vertexbuffer>
  </sharedgeometry>
  <submeshnames><submeshname name="second" index="1"/></submeshnames>
  <skeletonlink name="x"/><poses/><strangething/>
</mesh>)");
  ASSERT_EQ(loaded.scene.meshes.size(), 2u);
  const Mesh& mesh = loaded.scene.meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(4, 0, 0)));
  EXPECT_THAT(mesh.triangles, ElementsAre(uvec3(2, 1, 0)));
  EXPECT_THAT(mesh.normals, ElementsAre(Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)));
  EXPECT_THAT(mesh.texcoords, ElementsAre(Vec2(0.1f, 1), Vec2(0.2f, 1), Vec2(0.4f, 1)));
  EXPECT_THAT(mesh.colours, ElementsAre(Vec4(1), Vec4(2, 0, 0, 1), Vec4(0, 0, 1, 1)));
  EXPECT_EQ(mesh.name, "submesh 0");
  EXPECT_EQ(loaded.scene.meshes[1].name, "second");
  EXPECT_EQ(loaded.scene.meshes[1].positions.size(), 3u);
  EXPECT_EQ(loaded.report.unknown, (std::map<std::string, int>{{"mesh: strangething", 1}}));
}

TEST(OgreXml, ErrorsNameTheLine) {
  const auto with_position = [](const std::string& x) {
    return "<mesh>\n<sharedgeometry vertexcount='1'>\n<vertexbuffer positions='true'>\n"
           "<vertex><position x='" +
           x + "' y='0' z='0'/></vertex></vertexbuffer></sharedgeometry></mesh>";
  };
  for (const char* bad : {"nan", "NaN", "inf", "-inf", "1e999", "abc", "", "1,5", "1 2", "0x10"}) {
    EXPECT_THAT(error(with_position(bad)), StartsWith("test.mesh.xml:4: ")) << bad;
  }
  EXPECT_EQ(error(with_position("1e-60")), "no error");
  EXPECT_EQ(error(with_position(" +1.5e+0 ")), "no error");
  EXPECT_EQ(error(one_submesh(3, "triangle_list", "<face v1='0' v2='1' v3='3'/>")),
            "test.mesh.xml:2: the face uses vertex 3 of 3");
  EXPECT_THAT(error(one_submesh(3, "triangle_list", "<face v1='0' v2='1' v3='-1'/>")),
              HasSubstr("v3=\"-1\" is no count"));
  EXPECT_THAT(error(one_submesh(3, "triangle_list", "<face v1='0' v2='1'/>")),
              HasSubstr("<face> has no v3"));
  EXPECT_THAT(error(one_submesh(3, "triangles", kFace)), HasSubstr("\"triangles\" is unknown"));
  EXPECT_THAT(error(""), HasSubstr("is empty"));
  EXPECT_THAT(error("<scene/>"), HasSubstr("where <mesh> is expected"));
  EXPECT_THAT(error("<mesh><submeshes></mesh>"), HasSubstr("XML_ERROR_MISMATCHED_ELEMENT"));
  EXPECT_THAT(error("<mesh><submeshes><submesh usesharedvertices='true'/></submeshes></mesh>"),
              HasSubstr("there are none"));
  EXPECT_THAT(error("<mesh><sharedgeometry vertexcount='4000000000'><vertexbuffer "
                    "positions='true'/></sharedgeometry></mesh>"),
              HasSubstr("0 vertices where 4000000000 are announced"));
}

TEST(OgreXml, SeveralFindingsAreReportedAtOnce) {
  std::string faces;
  for (int i = 0; i < 6; ++i) faces += "\n<face v1='0' v2='1' v3='9'/>";
  const std::string message = error(one_submesh(3, "triangle_list", faces));
  EXPECT_THAT(message,
              StartsWith("test.mesh.xml:3: the face uses vertex 9 of 3; test.mesh.xml:4:"));
  EXPECT_THAT(message, HasSubstr("and 2 more"));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(OgreXml, DeepNestingIsRefused) {
  std::string text = "<mesh>";
  for (int i = 0; i < 100000; ++i) text += "<a>";
  EXPECT_THAT(error(text), HasSubstr("nest deeper than 100"));
}

TEST(OgreXml, TexturesOfASubmeshReplaceThoseOfTheirAliases) {
  const std::string text = one_submesh(
      3, "triangle_list", kFace, "<textures><texture alias='skin' name='other.png'/></textures>");
  LoadReport report;
  const ogre::MeshFile file = ogre::parse_xml(text, "test.mesh.xml", report);
  const Loaded loaded = assemble(file,
                                 "material stone { technique { pass { texture_unit {\n"
                                 "texture_alias skin\n texture first.png\n}}}}");
  ASSERT_EQ(loaded.scene.textures.size(), 1u);
  EXPECT_THAT(loaded.scene.textures[0].name, HasSubstr("other.png"));
}

}  // namespace
}  // namespace lantern
