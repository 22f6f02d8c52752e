// SPDX-License-Identifier: MIT
// XML and binary meshes against Ogre's own tools: both forms of a mesh give the same Scene.
#include "lantern/core/file.h"
#include "lantern/load/ogre_binary.h"
#include "lantern/load/ogre_xml.h"

#include "tests/load/ogre_files.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>

#include <cstdlib>

namespace lantern {
namespace {

using test::expect_same;
using test::TemporaryFolder;

bool is_installed(const char* tool) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", tool).c_str()) == 0;
}

/// Runs a command in the folder; the tools write their logs there.
bool run(const TemporaryFolder& folder, const std::string& command) {
  return std::system(fmt::format("cd '{}' && {} >/dev/null 2>&1", folder.path().string(), command)
                         .c_str()) == 0;
}

std::string vertex(int i, bool full) {
  const double x = 0.1 * i, y = 1.0 / (i + 3), z = (i % 7) * 1.5e-3;
  std::string text = fmt::format("<vertex><position x='{:.9g}' y='{:.9g}' z='{:.9g}'/>", x, y, z);
  if (full) {
    text += fmt::format(
        "<normal x='0' y='{:.9g}' z='1'/><colour_diffuse value='{:.6g} 0.25 1 0.5'/><texcoord "
        "u='{:.9g}' v='{:.9g}'/><texcoord u='7' v='8'/>",
        y, (i % 5) / 4.0, x, -y);
  }
  return text + "</vertex>\n";
}

std::string buffer(int vertices, bool full) {
  std::string text = full ? "<vertexbuffer positions='true' normals='true' colours_diffuse='true' "
                            "texture_coords='2' texture_coord_dimensions_0='float2' "
                            "texture_coord_dimensions_1='float2'>\n"
                          : "<vertexbuffer positions='true'>\n";
  for (int i = 0; i < vertices; ++i) text += vertex(i, full);
  return text + "</vertexbuffer>\n";
}

/// Shared and own geometry, lists, strips and fans, narrow and wide indices, names.
std::string mesh_text() {
  std::string text = "<mesh><sharedgeometry vertexcount='40'>" + buffer(40, true) +
                     "</sharedgeometry><submeshes>\n";
  const auto submesh = [&](const char* material, bool shared, bool wide, const char* operation,
                           const std::string& faces, int count) {
    text += fmt::format(
        "<submesh material='{}' usesharedvertices='{}' use32bitindexes='{}' operationtype='{}'>"
        "<faces count='{}'>{}</faces>",
        material, shared, wide, operation, count, faces);
    if (!shared) text += "<geometry vertexcount='12'>" + buffer(12, false) + "</geometry>";
    text += "</submesh>\n";
  };
  const std::string first = "<face v1='0' v2='1' v3='2'/>";
  const std::string strip =
      first +
      "<face v1='3'/><face v1='3'/><face v1='7'/><face v1='7'/><face v1='8'/><face v1='9'/>";
  submesh("list", true, false, "triangle_list",
          "<face v1='39' v2='3' v3='20'/><face v1='3' v2='5' v3='20'/>", 2);
  submesh("strip", true, false, "triangle_strip", strip, 7);
  submesh("own list", false, true, "triangle_list", "<face v1='11' v2='3' v3='2'/>", 1);
  submesh("own fan", false, false, "triangle_fan", first + "<face v1='7'/><face v1='11'/>", 3);
  submesh("own strip", false, true, "triangle_strip", strip, 7);
  return text +
         "</submeshes><submeshnames><submeshname name='first' index='0'/><submeshname name='last' "
         "index='4'/></submeshnames></mesh>";
}

class OgreConverter : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("OgreXMLConverter") || !is_installed("OgreMeshUpgrader")) {
      GTEST_SKIP() << "Ogre's tools are not installed (Debian: ogre-1.12-tools)";
    }
    write_file(folder_ / "in.mesh.xml", mesh_text());
  }
  Scene xml() const { return load_ogre_xml(folder_ / "in.mesh.xml", {}).scene; }

  TemporaryFolder folder_;
};

// The tool cuts colours off at the lower of 255 steps.
constexpr float kOneOf255 = 1.0f / 255.0f + 1e-6f;

TEST_F(OgreConverter, BinaryFromXmlIsTheSameScene) {
  for (const char* order : {"little", "big"}) {
    for (const char* colours : {"-gl", "-d3d", "-byte"}) {
      // The tool aborts where it should leave bytes unswapped.
      if (colours == std::string_view("-byte") && order == std::string_view("big")) continue;
      ASSERT_TRUE(run(folder_, fmt::format("OgreXMLConverter -q {} -E {} in.mesh.xml out.mesh",
                                           colours, order)));
      const Loaded binary = load_ogre_binary(folder_ / "out.mesh", {});
      EXPECT_EQ(binary.report.format, fmt::format("Ogre mesh 1.100, {}-endian", order));
      EXPECT_TRUE(binary.report.unknown.empty()) << binary.report.unknown.begin()->first;
      expect_same(xml(), binary.scene, kOneOf255);
    }
  }
}

TEST_F(OgreConverter, OwnScenesAreTheSameInBinary) {
  for (const char* name : {"cornell_box", "furnace", "two_rooms", "many_emitters"}) {
    const auto file = std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes" / name;
    const std::string text = file.string() + ".mesh.xml";
    ASSERT_TRUE(run(folder_, fmt::format("OgreXMLConverter -q '{}' own.mesh", text))) << name;
    expect_same(load_ogre_xml(text, {}).scene, load_ogre_binary(folder_ / "own.mesh", {}).scene);
  }
}

TEST_F(OgreConverter, OlderFormatsAreTheSameScene) {
  const std::map<std::string, std::string> formats{
      {"1.10", "1.100"}, {"1.8", "1.8"}, {"1.7", "1.41"}, {"1.4", "1.40"}, {"1.0", "1.30"}};
  ASSERT_TRUE(run(folder_, "OgreXMLConverter -q in.mesh.xml new.mesh"));
  for (const auto& [version, format] : formats) {
    for (const char* order : {"little", "big"}) {
      // Buffers stay as they are; edge lists are written, to be left out in reading.
      ASSERT_TRUE(run(folder_, fmt::format("OgreMeshUpgrader -r -E {} -V {} new.mesh old.mesh",
                                           order, version)));
      const Loaded binary = load_ogre_binary(folder_ / "old.mesh", {});
      EXPECT_EQ(binary.report.format, fmt::format("Ogre mesh {}, {}-endian", format, order));
      EXPECT_TRUE(binary.report.unknown.empty()) << binary.report.unknown.begin()->first;
      expect_same(xml(), binary.scene, kOneOf255);
    }
  }
}

TEST_F(OgreConverter, LevelsOfDetailAndExtremesAreLeftOut) {
  const auto rooms = std::filesystem::path(LANTERN_SOURCE_DIR) / "scenes/two_rooms.mesh.xml";
  ASSERT_TRUE(run(folder_, fmt::format("OgreXMLConverter -q -x 4 '{}' new.mesh", rooms.string())));
  const Scene xml = load_ogre_xml(rooms, {}).scene;
  for (const char* version : {"1.10", "1.8", "1.7", "1.4", "1.0"}) {
    ASSERT_TRUE(
        run(folder_,
            fmt::format("OgreMeshUpgrader -r -l 2 -d 10 -p 50 -V {} new.mesh lod.mesh", version)));
    const Loaded binary = load_ogre_binary(folder_ / "lod.mesh", {});
    EXPECT_TRUE(binary.report.unknown.empty()) << binary.report.unknown.begin()->first;
    expect_same(xml, binary.scene);
  }
}

TEST_F(OgreConverter, XmlFromBinaryIsTheSameMesh) {
  const auto shared = test::shared_folder("scenes/ogre");
  if (!shared) GTEST_SKIP() << "the shared Ogre scenes are not there";
  for (const char* name : {"cornell", "sibenik"}) {
    const auto file = *shared / fmt::format("{}.mesh", name);
    ASSERT_TRUE(
        run(folder_, fmt::format("OgreXMLConverter -q '{}' {}.mesh.xml", file.string(), name)));
    LoadReport report;
    const auto binary = ogre::parse_binary(read_file(file), name, report);
    const auto xml =
        ogre::parse_xml(read_text(folder_ / fmt::format("{}.mesh.xml", name)), name, report);
    ASSERT_EQ(binary.submeshes.size(), xml.submeshes.size());
    for (std::size_t i = 0; i < xml.submeshes.size(); ++i) {
      EXPECT_EQ(binary.submeshes[i].name, xml.submeshes[i].name);
      EXPECT_EQ(binary.submeshes[i].material, xml.submeshes[i].material);
      EXPECT_EQ(binary.submeshes[i].indices, xml.submeshes[i].indices);
      ASSERT_EQ(binary.submeshes[i].own.has_value(), xml.submeshes[i].own.has_value());
      if (!xml.submeshes[i].own) continue;
      const auto& a = binary.submeshes[i].own->positions;
      const auto& b = xml.submeshes[i].own->positions;
      ASSERT_EQ(a.size(), b.size());
      // The tool writes six digits.
      for (std::size_t v = 0; v < a.size(); ++v) {
        ASSERT_LE(glm::distance(a[v], b[v]), 1e-5f * (1.0f + glm::length(a[v])));
      }
    }
  }
}

}  // namespace
}  // namespace lantern
