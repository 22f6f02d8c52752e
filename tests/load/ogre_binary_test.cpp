// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_binary.h"

#include "tests/load/ogre_files.h"

#include <fmt/format.h>

#include <cmath>

namespace lantern {
namespace {

using test::assemble;
using test::BinaryMesh;
using test::bytes_of;
using test::ChunkWriter;
using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Parsed {
  Scene scene;
  LoadReport report;
};

Parsed parse(const std::string& bytes) {
  Parsed parsed;
  const ogre::MeshFile file = ogre::parse_binary(bytes_of(bytes), "test.mesh", parsed.report);
  parsed.scene = assemble(file, "material stone { }").scene;
  return parsed;
}

std::string error(const std::string& bytes) {
  return error_of([&] { parse(bytes); });
}

class OgreBinary : public ::testing::TestWithParam<std::endian> {};

INSTANTIATE_TEST_SUITE_P(ByteOrders, OgreBinary,
                         ::testing::Values(std::endian::little, std::endian::big),
                         [](const auto& order) {
                           return order.param == std::endian::little ? "little" : "big";
                         });

TEST_P(OgreBinary, VersionsAreReadOrRefusedByName) {
  BinaryMesh mesh;
  mesh.order = GetParam();
  for (const char* version : {"1.30", "1.40", "1.41", "1.8", "1.100"}) {
    mesh.version = fmt::format("[MeshSerializer_v{}]", version);
    const Parsed parsed = parse(mesh.write());
    EXPECT_EQ(parsed.report.format,
              fmt::format("Ogre mesh {}, {}-endian", version,
                          GetParam() == std::endian::little ? "little" : "big"));
    ASSERT_EQ(parsed.scene.meshes.size(), 1u);
    EXPECT_THAT(parsed.scene.meshes[0].positions,
                ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
    EXPECT_THAT(parsed.scene.meshes[0].triangles, ElementsAre(uvec3(0, 1, 2)));
    EXPECT_EQ(parsed.scene.materials[0].name, "stone");
    EXPECT_TRUE(parsed.report.unknown.empty());
  }
  for (const char* version : {"[MeshSerializer_v1.10]", "[MeshSerializer_v1.20]",
                              "[MeshSerializer_v2.1 R2]", "[Serializer_v1.00]", ""}) {
    mesh.version = version;
    EXPECT_THAT(error(mesh.write()),
                StartsWith(fmt::format("test.mesh: byte 2: version '{}'", version)));
  }
}

TEST_P(OgreBinary, WideIndicesStripsNamesAndAliases) {
  BinaryMesh mesh;
  mesh.order = GetParam();
  mesh.wide_indices = true;
  mesh.vertices = 4;
  mesh.indices = {0, 1, 2, 3};
  mesh.operation = 5;
  mesh.data = [](ChunkWriter& w) { w.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}); };
  mesh.in_submesh = [](ChunkWriter& w) {
    w.chunk(0x4100, [&] { w.u32(0).u16(0).put(1.0f); });
    w.chunk(0x4200, [&] { w.string("skin").string("a.png"); });
  };
  mesh.in_mesh = [](ChunkWriter& w) {
    w.chunk(0x6000, [&] { w.string("bones.skeleton"); });
    w.chunk(0x9000, [&] { w.put_all<float>({0, 0, 0, 1, 1, 0, 2}); });
    w.chunk(0xA000, [&] { w.chunk(0xA100, [&] { w.u16(0).string("roof"); }); });
    w.chunk(0xB000, [&] { w.u32(7); });
    w.chunk(0xE000, [&] { w.u16(0).put_all<float>({0, 0, 0}); });
    w.chunk(0x1234, [&] { w.u32(7); });
  };
  LoadReport report;
  const ogre::MeshFile file = ogre::parse_binary(bytes_of(mesh.write()), "test.mesh", report);
  ASSERT_EQ(file.submeshes.size(), 1u);
  EXPECT_EQ(file.submeshes[0].name, "roof");
  EXPECT_EQ(file.submeshes[0].textures.at("skin"), "a.png");
  EXPECT_EQ(report.unknown, (std::map<std::string, int>{{"mesh: chunk 0x1234", 1}}));
  EXPECT_THAT(assemble(file, "material stone { }").scene.meshes[0].triangles,
              ElementsAre(uvec3(0, 1, 2), uvec3(2, 1, 3)));
}

TEST_P(OgreBinary, ColoursOfEitherOrder) {
  BinaryMesh mesh;
  mesh.order = GetParam();
  mesh.stride = 16;
  mesh.data = [](ChunkWriter& w) {
    for (int i = 0; i < 3; ++i) w.put_all<float>({0, static_cast<float>(i), 0}).u32(0x80ff3300);
  };
  mesh.elements = {{2, 1, 0}, {10, 5, 12}};
  EXPECT_EQ(parse(mesh.write()).scene.meshes[0].colours.at(0), Vec4(1, 0.2f, 0, 128.0f / 255));
  mesh.elements = {{2, 1, 0}, {11, 5, 12}};
  EXPECT_EQ(parse(mesh.write()).scene.meshes[0].colours.at(0), Vec4(0, 0.2f, 1, 128.0f / 255));
  // Bytes have no order to swap.
  mesh.elements = {{2, 1, 0}, {30, 5, 12}};
  mesh.data = [](ChunkWriter& w) {
    for (int i = 0; i < 3; ++i) {
      w.put_all<float>({0, static_cast<float>(i), 0}).u8(255).u8(51).u8(0).u8(128);
    }
  };
  EXPECT_EQ(parse(mesh.write()).scene.meshes[0].colours.at(0), Vec4(1, 0.2f, 0, 128.0f / 255));
}

TEST_P(OgreBinary, ElementTypesOfLaterFormats) {
  BinaryMesh mesh;
  mesh.order = GetParam();
  // Positions as doubles, normals as four normalised shorts, texture coordinates as two halves; a
  // second set, met first, is not the one that counts.
  mesh.elements = {{14, 1, 0}, {32, 4, 24}, {0, 7, 36, 0, 1}, {37, 7, 32, 0, 0}};
  mesh.stride = 40;
  mesh.data = [](ChunkWriter& w) {
    for (int i = 0; i < 3; ++i) {
      w.put_all<double>({0.5, static_cast<double>(i), 0});
      w.put_all<std::int16_t>({0, -32767, 32767, 0});
      w.put_all<std::uint16_t>({0x3800, 0xc000});  // 0.5, -2
      w.put(9.0f);
    }
  };
  const Parsed parsed = parse(mesh.write());
  const Mesh& result = parsed.scene.meshes[0];
  EXPECT_EQ(result.positions.at(1), Vec3(0.5f, 1, 0));
  EXPECT_EQ(result.normals.at(1), Vec3(0, -1, 1));
  EXPECT_EQ(result.texcoords.at(1), Vec2(0.5f, -2));

  // Halves, ten-bit normals, one-dimensional texture coordinates.
  mesh.elements = {{38, 1, 0}, {35, 4, 8}, {0, 7, 12}};
  mesh.stride = 16;
  mesh.data = [](ChunkWriter& w) {
    for (int i = 0; i < 3; ++i) {
      w.put_all<std::uint16_t>({0x3c00, static_cast<std::uint16_t>(0x3c00 + i * 0x400), 0, 0});
      w.u32(0x201u | 511u << 20).put(0.25f);
    }
  };
  const Parsed halves = parse(mesh.write());
  EXPECT_EQ(halves.scene.meshes[0].positions.at(2), Vec3(1, 4, 0));
  EXPECT_EQ(halves.scene.meshes[0].normals.at(0), Vec3(-1, 0, 1));
  EXPECT_EQ(halves.scene.meshes[0].texcoords.at(0), Vec2(0.25f, 0));
}

TEST_P(OgreBinary, UnreadableElementsAreErrorsForPositionsAndCountedElse) {
  BinaryMesh mesh;
  mesh.order = GetParam();
  mesh.elements = {{2, 1, 0}, {9, 7, 0}};
  EXPECT_EQ(parse(mesh.write()).report.unknown,
            (std::map<std::string, int>{{"mesh: vertex element type 9", 1}}));
  for (int type : {0, 1, 9, 10, 30000}) {
    mesh.elements = {{type, 1, 0}};
    EXPECT_THAT(error(mesh.write()), HasSubstr(fmt::format("of vertex element type {}", type)));
  }
}

TEST(OgreBinaryShared, MayFollowWhatUsesItAndIsCompacted) {
  BinaryMesh shared;
  ChunkWriter w;
  w.u16(0x1000).string("[MeshSerializer_v1.8]");
  w.chunk(0x3000, [&] {
    w.u8(0);
    w.chunk(0x4000, [&] { w.string("a").u8(1).u32(3).u8(0).u16(3).u16(2).u16(1); });
    shared.vertices = 4;
    shared.data = [](ChunkWriter& data) {
      data.put_all<float>({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
    };
    shared.write_geometry(w);
  });
  const Parsed parsed = parse(w.text());
  EXPECT_THAT(parsed.scene.meshes[0].positions,
              ElementsAre(Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)));
  EXPECT_THAT(parsed.scene.meshes[0].triangles, ElementsAre(uvec3(2, 1, 0)));
}

TEST(OgreBinaryShared, ManySubmeshesOfManyVerticesTakeNoMoreThanTheirTriangles) {
  ChunkWriter w;
  w.u16(0x1000).string("[MeshSerializer_v1.8]");
  w.chunk(0x3000, [&] {
    w.u8(0);
    BinaryMesh shared;
    shared.vertices = 30000;
    shared.data = [](ChunkWriter& data) {
      for (int i = 0; i < 3 * 30000; ++i) data.put(0.0f);
    };
    shared.write_geometry(w);
  });
  // Half of the submeshes have no indices at all.
  std::string file = w.text();
  for (int i = 0; i < 30000; ++i) {
    ChunkWriter submesh;
    submesh.chunk(0x4000, [&] {
      submesh.string("a").u8(1);
      if (i % 2 == 0) {
        submesh.u32(3).u8(0).u16(0).u16(1).u16(i);
      } else {
        submesh.u32(0).u8(0);
      }
    });
    file += submesh.text();
  }
  const Parsed parsed = parse(file);
  std::size_t vertices = 0;
  for (const Mesh& mesh : parsed.scene.meshes) vertices += mesh.positions.size();
  EXPECT_EQ(parsed.scene.meshes.size(), 30000u);
  EXPECT_LE(vertices, 45000u);
}

TEST(OgreBinaryErrors, NameTheByte) {
  EXPECT_THAT(error(""), StartsWith("test.mesh: byte 0: "));
  EXPECT_THAT(error("\x10"), StartsWith("test.mesh: byte 0: "));
  EXPECT_EQ(error("glTF"), "test.mesh: byte 0: is no Ogre mesh");
  BinaryMesh mesh;
  mesh.indices = {0, 1, 3};
  const std::size_t third_index = mesh.write().find("stone\n") + 6 + 1 + 4 + 1 + 2 * 2;
  EXPECT_EQ(error(mesh.write()),
            fmt::format("test.mesh: byte {}: submesh 0 uses vertex 3 of 3", third_index));
  mesh = {};
  for (float bad : {NAN, INFINITY, -INFINITY}) {
    mesh.data = [bad](ChunkWriter& w) { w.put_all<float>({0, 0, 0, 1, bad, 0, 0, 1, 0}); };
    EXPECT_THAT(error(mesh.write()), HasSubstr("vertex 1 is not at a finite place"));
  }
  mesh = {};
  mesh.operation = 7;
  EXPECT_THAT(error(mesh.write()), HasSubstr("operation 7 is unknown"));
  mesh = {};
  mesh.elements = {{2, 1, 4}};
  EXPECT_THAT(error(mesh.write()), HasSubstr("ends at byte 16 of a vertex of 12"));
  mesh.elements = {{2, 1, 0, 5}};
  EXPECT_THAT(error(mesh.write()), HasSubstr("buffer 5, which is not there"));
  mesh.elements = {};
  EXPECT_THAT(error(mesh.write()), HasSubstr("3 vertices without positions"));
  mesh = {};
  mesh.in_mesh = [](ChunkWriter& w) {
    w.chunk(0xA000, [&] { w.chunk(0xA100, [&] { w.u16(4).string("x"); }); });
  };
  EXPECT_THAT(error(mesh.write()), HasSubstr("names submesh 4 of 1"));
  mesh.in_mesh = [](ChunkWriter& w) { w.u16(0x9000).u32(5); };
  EXPECT_THAT(error(mesh.write()), HasSubstr("has a length of 5 bytes"));
}

TEST(OgreBinaryErrors, HugeCountsInSmallFiles) {
  BinaryMesh mesh;
  for (std::uint32_t count : {4u, 1000000u, 0x7fffffffu, 0xffffffffu}) {
    mesh.vertices = count;
    EXPECT_THAT(error(mesh.write()), HasSubstr(fmt::format("where {} vertices of 12 need", count)));
  }
  // No bytes a vertex: the buffer is as long as it says, and yet nothing can be in it.
  mesh.stride = 0;
  mesh.data = [](ChunkWriter&) {};
  EXPECT_THAT(error(mesh.write()), HasSubstr("ends at byte 12 of a vertex of 0"));
  std::string bytes = BinaryMesh{}.write();
  const std::size_t count_at = bytes.find("stone\n") + 7;
  for (std::size_t i = 0; i < 4; ++i) bytes[count_at + i] = '\xff';
  EXPECT_THAT(error(bytes), HasSubstr("the list of indices needs 8589934590 bytes"));
}

TEST(OgreBinaryErrors, TruncatedAnywhere) {
  BinaryMesh mesh;
  mesh.in_mesh = [](ChunkWriter& w) {
    w.chunk(0x9000, [&] { w.put_all<float>({0, 0, 0, 1, 1, 0, 2}); });
  };
  const std::string whole = mesh.write();
  EXPECT_EQ(error(whole), "no error");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(error(whole.substr(0, size)), StartsWith("test.mesh: byte ")) << size;
  }
}

TEST(OgreBinaryErrors, AnyByteChangedIsReadOrRefused) {
  const std::string whole = BinaryMesh{}.write();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (char value : {'\0', '\1', '\x7f', '\x80', '\xff'}) {
      std::string changed = whole;
      changed[i] = value;
      error(changed);
    }
  }
}

}  // namespace
}  // namespace lantern
