// SPDX-License-Identifier: MIT
#include "tests/load/load_files.h"

#include <cmath>
#include <limits>

namespace lantern::test {
namespace {

using GltfTest = LoadTest;

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

const std::string kPngUri = "data:image/png;base64," + std::string(kPng64);

TEST_F(GltfTest, ReadsOneTriangle) {
  const Loaded loaded = load("a.gltf", Gltf().text());
  EXPECT_EQ(loaded.report.format, "glTF 2.0");
  EXPECT_THAT(loaded.report.warnings, ::testing::IsEmpty());
  ASSERT_EQ(loaded.scene.meshes.size(), 1u);
  const Mesh& mesh = loaded.scene.meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}}));
  EXPECT_TRUE(mesh.normals.empty());
  ASSERT_EQ(loaded.scene.instances.size(), 1u);
  EXPECT_EQ(loaded.scene.instances[0].transform, Mat4(1.0f));
  // A primitive without a material has the default one of glTF: white.
  ASSERT_EQ(loaded.scene.materials.size(), 1u);
  EXPECT_EQ(loaded.scene.materials[0].reflectance, Rgb(1.0f));
}

TEST_F(GltfTest, ReadsGlb) {
  Gltf gltf;
  gltf.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.primitive()["material"] = 0;
  gltf.add("SCALAR", from_base64(kPng64), 5121);
  const Loaded loaded = load("a.glb", gltf.glb());
  EXPECT_EQ(loaded.report.format, "glTF 2.0, binary");
  EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(1), Vec3(1, 0, 0));
  ASSERT_EQ(loaded.scene.textures.size(), 1u);
  // Row 0 is the picture's top row: red, green.
  EXPECT_THAT(
      loaded.scene.textures[0].srgb8,
      ::testing::ElementsAre(255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 128, 255, 255, 255, 255));
}

TEST_F(GltfTest, ANodesTransformsMultiplyAndAMeshIsShared) {
  Gltf gltf;
  gltf.json["nodes"] = Json::parse(R"([
    {"translation": [1, 2, 3], "children": [1, 2]},
    {"mesh": 0, "scale": [2, 2, 2]},
    {"mesh": 0, "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,0,0,1]},
    {"mesh": 0}])");  // the last is in no scene
  const Loaded loaded = load("a.gltf", gltf.text());
  EXPECT_EQ(loaded.scene.meshes.size(), 1u);
  ASSERT_EQ(loaded.scene.instances.size(), 2u);
  const Vec4 x(1, 0, 0, 1);
  expect_near(Vec3(loaded.scene.instances[0].transform * x), {3, 2, 3});
  // A quarter turn takes x to y; then (5, 0, 0) and the parent's (1, 2, 3).
  expect_near(Vec3(loaded.scene.instances[1].transform * x), {6, 3, 3});
}

TEST_F(GltfTest, RotationIsXyzw) {
  Gltf gltf;
  const double s = std::sqrt(0.5);
  gltf.json["nodes"][0]["rotation"] = {0, 0, s, s};  // a quarter turn about z
  const Loaded loaded = load("a.gltf", gltf.text());
  expect_near(Vec3(loaded.scene.instances.at(0).transform * Vec4(1, 0, 0, 1)), {0, 1, 0});
}

TEST_F(GltfTest, ReadsMaterials) {
  Gltf gltf;
  gltf.json["materials"] = Json::parse(R"([
    {"name": "unused"},
    {"name": "lamp", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.3,
     "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75],
                              "baseColorTexture": {"index": 0}},
     "emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 1},
     "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 40}}},
    {"name": "mask", "alphaMode": "MASK"}, {"name": "glass", "alphaMode": "BLEND"}])");
  gltf.json["textures"] = Json::parse(R"([{"source": 0, "sampler": 0}, {"source": 0}])");
  gltf.json["samplers"] = Json::parse(R"([{"wrapS": 33071, "wrapT": 33648}])");
  gltf.json["images"] = {{{"uri", kPngUri}}};
  gltf.primitive()["material"] = 1;
  const Loaded loaded = load("a.gltf", gltf.text());
  const Scene& scene = loaded.scene;
  EXPECT_EQ(scene.meshes.at(0).material, MaterialId{1});
  ASSERT_EQ(scene.materials.size(), 4u);
  const Material& lamp = scene.materials[1];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.reflectance, Rgb(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(lamp.emission, Rgb(40, 20, 0));
  EXPECT_TRUE(lamp.double_sided);
  EXPECT_EQ(lamp.opacity, 0.75f);
  EXPECT_EQ(lamp.alpha_cutoff, 0.3f);
  EXPECT_FALSE(scene.materials[0].double_sided);
  EXPECT_EQ(scene.materials[0].alpha_cutoff, std::nullopt);
  EXPECT_EQ(scene.materials[2].alpha_cutoff, 0.5f);
  EXPECT_EQ(scene.materials[3].alpha_cutoff, std::nullopt);
  EXPECT_FALSE(scene.materials[2].blend);
  EXPECT_TRUE(scene.materials[3].blend);
  EXPECT_TRUE(loaded.report.warnings.empty());
  const Texture& clamped = scene.textures.at(index(lamp.reflectance_texture.value()));
  EXPECT_EQ(clamped.wrap_u, Wrap::kClamp);
  EXPECT_EQ(clamped.wrap_v, Wrap::kMirror);
  const Texture& repeated = scene.textures.at(index(lamp.emission_texture.value()));
  EXPECT_EQ(repeated.wrap_u, Wrap::kRepeat);
  EXPECT_EQ(repeated.width, 2);
}

TEST_F(GltfTest, ReadsVertexAttributesOfAnyComponentType) {
  Gltf gltf;
  Json& attributes = gltf.primitive()["attributes"];
  attributes["NORMAL"] = gltf.add("VEC3", raw<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}));
  attributes["TEXCOORD_0"] = gltf.add("VEC2", raw<std::uint16_t>({0, 0, 65535, 0, 0, 13107}), 5123);
  attributes["COLOR_0"] =
      gltf.add("VEC3", raw<std::uint8_t>({255, 0, 0, 0, 51, 0, 0, 0, 255}), 5121);
  gltf.json["accessors"][3]["normalized"] = true;
  gltf.json["accessors"][4]["normalized"] = true;
  const Loaded loaded = load("a.gltf", gltf.text());
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_EQ(mesh.normals, std::vector<Vec3>(3, {0, 0, 1}));
  // v = 0 is the first row in glTF as it is here; 13107 / 65535 = 0.2.
  EXPECT_EQ(mesh.texcoords, (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 0.2f}}));
  EXPECT_EQ(mesh.colours, (std::vector<Vec4>{{1, 0, 0, 1}, {0, 0.2f, 0, 1}, {0, 0, 1, 1}}));
  EXPECT_TRUE(loaded.scene.materials.at(index(mesh.material)).vertex_colours);
}

TEST_F(GltfTest, AnInterleavedAndSharedBufferGivesEachPrimitiveWhatItUses) {
  Gltf gltf;
  // Position and a filler word per vertex: five vertices of 16 bytes.
  gltf.add("VEC4", raw<float>({9, 9, 9, 0, 0, 0, 0, 0, 8, 8, 8, 0, 1, 0, 0, 0, 0, 1, 0, 0}));
  gltf.json["bufferViews"][2]["byteStride"] = 16;
  gltf.json["accessors"][2]["type"] = "VEC3";
  gltf.primitive()["attributes"]["POSITION"] = 2;
  gltf.primitive()["indices"] = gltf.add("SCALAR", raw<std::uint32_t>({1, 3, 4}), 5125);
  const Mesh mesh = load("a.gltf", gltf.text()).scene.meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}}));
}

TEST_F(GltfTest, StripsAndFansKeepTheFront) {
  Gltf gltf;
  const std::size_t quad = gltf.add("VEC3", raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
  const auto of_mode = [&](int mode) {
    gltf.primitive() = {{"attributes", {{"POSITION", quad}}}, {"mode", mode}};
    return load("a.gltf", gltf.text()).scene.meshes.at(0).triangles;
  };
  EXPECT_EQ(of_mode(5), (std::vector<uvec3>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(of_mode(6), (std::vector<uvec3>{{1, 2, 0}, {2, 3, 0}}));
}

TEST_F(GltfTest, PointsAndLinesAreDroppedAndCounted) {
  Gltf gltf;
  gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 3}});
  const Loaded loaded = load("a.gltf", gltf.text());
  EXPECT_EQ(loaded.scene.meshes.size(), 1u);
  EXPECT_THAT(loaded.report.warnings,
              ::testing::ElementsAre("2 primitives of points or lines left out"));
}

TEST_F(GltfTest, CamerasFollowTheirNodes) {
  Gltf gltf;
  gltf.json["cameras"] = Json::parse(R"([
    {"type": "perspective", "perspective": {"yfov": 0.8, "aspectRatio": 2, "znear": 0.1}},
    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}])");
  const double s = std::sqrt(0.5);
  gltf.json["nodes"] = Json::parse(R"([{"mesh": 0}, {"camera": 0, "name": "a"},
    {"camera": 0, "name": "b", "translation": [0, 0, 5]}, {"camera": 1}])");
  gltf.json["nodes"][2]["rotation"] = {0, s, 0, s};  // a quarter turn about y: -z becomes -x
  gltf.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Loaded loaded = load("a.gltf", gltf.text());
  ASSERT_EQ(loaded.scene.cameras.size(), 2u);
  const Camera &a = loaded.scene.cameras[0], &b = loaded.scene.cameras[1];
  EXPECT_EQ(a.name, "a");
  expect_near(a.forward, {0, 0, -1});
  EXPECT_EQ(b.name, "b");
  expect_near(b.eye, {0, 0, 5});
  expect_near(b.forward, {-1, 0, 0});
  expect_near(b.up, {0, 1, 0});
  EXPECT_FLOAT_EQ(b.vertical_fov, 0.8f);  // vertical whatever the aspect
  EXPECT_EQ(loaded.report.unknown.at("orthographic camera"), 1);
}

TEST_F(GltfTest, LightsKeepTheirNumbersAndEachUse) {
  Gltf gltf;
  gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
    {"type": "point", "color": [1, 0.5, 0.25], "intensity": 1e6},
    {"type": "spot", "intensity": 40, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.3}},
    {"type": "directional", "intensity": 3}])");
  const auto node = [](int light, Json::array_t at) {
    return Json{{"translation", at}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
  };
  for (const Json& n :
       {node(0, {0, 4, 0}), node(0, {0, 5, 0}), node(1, {0, 0, 0}), node(2, {0, 0, 0})}) {
    gltf.json["scenes"][0]["nodes"].push_back(gltf.json["nodes"].size());
    gltf.json["nodes"].push_back(n);
  }
  const double s = std::sqrt(0.5);
  gltf.json["nodes"][4]["rotation"] = {-s, 0, 0, s};  // -z becomes -y
  const Loaded loaded = load("a.gltf", gltf.text());
  EXPECT_TRUE(loaded.report.unknown.empty());
  const auto& lights = loaded.scene.lights;
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].kind, PunctualKind::kPoint);
  EXPECT_EQ(lights[0].intensity, Rgb(1e6f, 5e5f, 2.5e5f));
  EXPECT_EQ(lights[0].position, Vec3(0, 4, 0));
  EXPECT_EQ(lights[1].position, Vec3(0, 5, 0));
  EXPECT_EQ(lights[2].kind, PunctualKind::kSpot);
  EXPECT_EQ(lights[2].intensity, Rgb(40));
  EXPECT_EQ(lights[2].inner_angle, 0.1f);
  EXPECT_EQ(lights[2].outer_angle, 0.3f);
  expect_near(lights[2].direction, {0, 0, -1});
  EXPECT_EQ(lights[3].kind, PunctualKind::kDirectional);
  EXPECT_EQ(lights[3].intensity, Rgb(3));
  expect_near(lights[3].direction, {0, -1, 0});
}

TEST_F(GltfTest, MovesTextureCoordinatesAsTheMaterialSays) {
  Gltf gltf;
  gltf.primitive()["attributes"]["TEXCOORD_1"] = gltf.add("VEC2", raw<float>({0, 0, 1, 0, 0, 1}));
  gltf.primitive()["material"] = 0;
  gltf.json["images"] = {{{"uri", kPngUri}}};
  gltf.json["textures"] = {{{"source", 0}}};
  Json& texture = gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture = {{"index", 0}, {"texCoord", 1}};
  texture["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"scale", {2, 4}}, {"rotation", kPi / 2}};
  const auto texcoords = load("a.gltf", gltf.text()).scene.meshes.at(0).texcoords;
  ASSERT_EQ(texcoords.size(), 3u);
  // Counter-clockwise where v points down: u goes to -v, v to u.
  const Vec2 expected[] = {{0.5f, 0.25f}, {0.5f, 0.25f - 2.0f}, {0.5f + 4.0f, 0.25f}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(texcoords[i].x, expected[i].x, 1e-6f);
    EXPECT_NEAR(texcoords[i].y, expected[i].y, 1e-6f);
  }
}

TEST_F(GltfTest, ReadsBuffersAndPicturesBesideIt) {
  Gltf gltf;
  gltf.json["images"] = {{{"uri", "a%20picture.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {{{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}}};
  Json document = Json::parse(gltf.text());
  const std::string uri = document["buffers"][0]["uri"];
  document["buffers"][0]["uri"] = "data.bin";
  write("data.bin", from_base64(std::string_view(uri).substr(uri.find(',') + 1)));
  write("a picture.png", from_base64(kPng64));
  const Loaded loaded = load("a.gltf", document.dump());
  EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(1), Vec3(1, 0, 0));
  EXPECT_EQ(loaded.scene.textures.at(0).height, 2);
}

TEST_F(GltfTest, UnknownExtensionsAreCountedUnlessRequired) {
  Gltf gltf;
  gltf.json["extensionsUsed"] = {"KHR_materials_clearcoat", "EXT_strange"};
  EXPECT_EQ(load("a.gltf", gltf.text()).report.unknown.at("EXT_strange"), 1);
  gltf.json["extensionsRequired"] = {"EXT_strange"};
  EXPECT_THAT(error_of("a.gltf", gltf.text()),
              ::testing::HasSubstr("needs the extension EXT_strange"));
}

// --- Broken files
// ----------------------------------------------------------------------------------

TEST_F(GltfTest, BrokenJsonNamesLineAndColumn) {
  EXPECT_THAT(error_of("a.gltf", "{\"asset\":\n  ?}"), ::testing::HasSubstr("a.gltf:2:3: "));
  EXPECT_THAT(error_of("a.gltf", ""), ::testing::HasSubstr("a.gltf:1:"));
  EXPECT_NE(error_of("a.gltf", "[]"), "");
  EXPECT_NE(error_of("a.gltf", "{}"), "");
  EXPECT_NE(error_of("a.gltf", R"({"asset": {"version": "1.0"}})"), "");
}

TEST_F(GltfTest, TruncatedFilesEndInAnError) {
  Gltf gltf;
  gltf.json["images"] = {{{"uri", kPngUri}}};
  gltf.json["textures"] = {{{"source", 0}}};
  expect_survives_truncation("a.gltf", gltf.text());
  const std::string glb = gltf.glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    EXPECT_NE(error_of("a.glb", glb.substr(0, size)), "") << size;
  }
}

TEST_F(GltfTest, GlbWithWrongLengthsNamesTheByte) {
  std::string glb = Gltf().glb();
  glb[8] = '\xff';
  glb[9] = '\xff';
  EXPECT_THAT(error_of("a.glb", glb), ::testing::HasSubstr("a.glb: byte 8: "));
  glb = Gltf().glb();
  glb[15] = '\x7f';
  EXPECT_THAT(error_of("a.glb", glb), ::testing::HasSubstr("a.glb: byte 12: "));
}

/// One change to a valid file, and a part of the message it must lead to.
struct Fault {
  const char* patch;  // JSON merge patch [RFC 7396], with numeric keys for places in a list
  const char* message;
};

void merge(Json& target, const Json& patch) {
  for (const auto& [key, value] : patch.items()) {
    Json& place = target.is_array() ? target[std::stoul(key)] : target[key];
    if (value.is_object() && place.is_structured()) {
      merge(place, value);
    } else {
      place = value;
    }
  }
}

const std::vector<Fault> kFaults = {
    Fault{R"({"accessors": {"0": {"count": 4}}})", "accessors[0]: its 4 elements reach beyond"},
    Fault{R"({"accessors": {"0": {"count": 9007199254740991}}})", "reach beyond"},
    Fault{R"({"accessors": {"0": {"count": 1e300}}})", "'count' is no index or count"},
    Fault{R"({"accessors": {"0": {"count": -1}}})", "'count' is no index or count"},
    Fault{R"({"accessors": {"0": {"byteOffset": 4}}})", "reach beyond its bufferView"},
    Fault{R"({"accessors": {"0": {"byteOffset": 9007199254740991}}})", "reach beyond"},
    Fault{R"({"accessors": {"0": {"componentType": 5124}}})", "componentType is unknown"},
    Fault{R"({"accessors": {"0": {"type": "MAT4"}}})", "type is not one"},
    Fault{R"({"accessors": {"0": {"type": "VEC2"}}})", "too few components"},
    Fault{R"({"accessors": {"0": {"bufferView": 7}}})", "there is no bufferViews[7]"},
    Fault{R"({"accessors": {"0": 3}})", "accessors[0] is no object"},
    Fault{R"({"accessors": {"1": {"componentType": 5126, "count": 1}}})", "no unsigned"},
    Fault{R"({"bufferViews": {"0": {"byteLength": 99}}})", "beyond its buffer"},
    Fault{R"({"bufferViews": {"0": {"byteStride": 2}}})", "overlap"},
    Fault{R"({"bufferViews": {"0": {"byteStride": 4000000000}}})", "reach beyond"},
    Fault{R"({"bufferViews": {"0": {"buffer": 1}}})", "there is no buffers[1]"},
    Fault{R"({"buffers": {"0": {"byteLength": 99999}}})", "claims 99999 bytes"},
    Fault{R"({"buffers": {"0": {"uri": "data:;base64,????"}}})", "not base64"},
    Fault{R"({"buffers": {"0": {"uri": "data:,hello"}}})", "not base64"},
    Fault{R"({"buffers": {"0": {"uri": "not-there.bin"}}})", "not-there.bin: no such file"},
    Fault{R"({"buffers": {"0": {"uri": 5}}})", "'uri' is no text"},
    Fault{R"({"nodes": {"0": {"children": [0]}}})", "nodes[0]: has two parents"},
    Fault{R"({"nodes": {"0": {"children": [9]}}})", "there is no nodes[9]"},
    Fault{R"({"nodes": {"0": {"mesh": 2}}})", "there is no meshes[2]"},
    Fault{R"({"nodes": {"0": {"mesh": "x"}}})", "'mesh' is no index"},
    Fault{R"({"nodes": {"0": {"matrix": [1, 2]}}})", "'matrix' is not 16 numbers"},
    Fault{R"({"nodes": {"0": {"scale": [1, 2, null]}}})", "'scale' is not 3 numbers"},
    Fault{R"({"nodes": {"0": {"scale": [1e300, 1, 1]}}})", "not finite"},
    Fault{R"({"nodes": {"0": {"camera": 0}}})", "there is no cameras[0]"},
    Fault{R"({"scene": 3})", "there is no scenes[3]"},
    Fault{R"({"scenes": 3})", "'scenes' is no object"},
    Fault{R"({"meshes": {"0": {"primitives": {"0": {"material": 0}}}}})", "no materials[0]"},
    Fault{R"({"materials": [{"emissiveTexture": {"index": 0}}]})", "no textures[0]"},
    Fault{R"({"materials": [{"emissiveFactor": "red"}]})", "materials[0]: 'emissiveFactor'"},
    Fault{R"({"meshes": [{"primitives": []}]})", "has no triangles"},
    Fault{R"({"nodes": [{}]})", "has no triangles"}};

TEST_F(GltfTest, FaultsEndInOneLine) {
  for (const auto& [patch, message] : kFaults) {
    Json document = Json::parse(Gltf().text());
    merge(document, Json::parse(patch));
    EXPECT_THAT(error_of("a.gltf", document.dump()), ::testing::HasSubstr(message)) << patch;
  }
}

TEST_F(GltfTest, IndicesOutOfRangeAndBadCoordinates) {
  Gltf out_of_range;
  out_of_range.primitive()["indices"] =
      out_of_range.add("SCALAR", raw<std::uint16_t>({0, 1, 99}), 5123);
  EXPECT_THAT(error_of("a.gltf", out_of_range.text()), ::testing::HasSubstr("index 99 of 3"));

  for (const float bad : {std::nanf(""), kInfinity}) {
    Gltf gltf;
    gltf.primitive()["attributes"]["POSITION"] =
        gltf.add("VEC3", raw<float>({0, 0, 0, 1, bad, 0, 0, 1, 0}));
    EXPECT_THAT(error_of("a.gltf", gltf.text()), ::testing::HasSubstr("not at a finite place"));
  }
}

TEST_F(GltfTest, AnAccessorWithoutDataIsZeroAndCannotEatTheMemory) {
  Gltf gltf;
  gltf.json["accessors"][0].erase("bufferView");
  // All corners in one place: nothing is left of it.
  EXPECT_THAT(error_of("a.gltf", gltf.text()), ::testing::HasSubstr("has no triangles"));
  gltf.json["accessors"][0]["count"] = 1ull << 40;
  EXPECT_THAT(error_of("a.gltf", gltf.text()), ::testing::HasSubstr("vertices and indices"));
}

TEST_F(GltfTest, ALongChainOfNodesIsNoProblem) {
  Gltf gltf;
  constexpr int kLength = 20000;
  gltf.json["nodes"] = Json::array();
  for (int i = 0; i < kLength; ++i) gltf.json["nodes"].push_back({{"children", {i + 1}}});
  gltf.json["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(load("a.gltf", gltf.text()).scene.instances.size(), 1u);
  EXPECT_NE(error_of("a.gltf", std::string(1 << 20, '[')), "");
}

}  // namespace
}  // namespace lantern::test
