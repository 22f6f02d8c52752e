// SPDX-License-Identifier: MIT
#include "lantern/load/assimp_scene.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/load/textures.h"

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <utility>

namespace lantern {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

/// assimp 5.2 counts the numbers of an OBJ line by their first characters and takes ".5" for none:
/// "0.5" is the same number.
std::string with_leading_zeros(const std::string& text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts = i > 0 && (text[i - 1] == ' ' || text[i - 1] == '\t');
    const bool number =
        i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1]));
    if (text[i] == '.' && starts && number) result += '0';
    result += text[i];
  }
  return result;
}

/// Regular files of bearable size, read whole and never written.
class ReadOnlyFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* name) const override {
    std::error_code code;
    return std::filesystem::is_regular_file(name, code) &&
           std::filesystem::file_size(name, code) <= kLargestFile && !code;
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (std::strchr(mode, 'r') == nullptr || !Exists(name)) return nullptr;
    std::string bytes = read_text(name);
    if (extension(name) == ".obj") bytes = with_leading_zeros(bytes);
    auto copy = std::make_unique<std::uint8_t[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), copy.get());
    return new Assimp::MemoryIOStream(copy.release(), bytes.size(), /*own=*/true);
  }
  void Close(Assimp::IOStream* file) override { delete file; }
};

Vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }
Rgb to_rgb(const aiColor3D& c) { return {c.r, c.g, c.b}; }
std::string to_text(const aiString& s) { return {s.data, s.length}; }

Mat4 to_mat4(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
          m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

Wrap to_wrap(aiTextureMapMode mode) {
  if (mode == aiTextureMapMode_Mirror) return Wrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? Wrap::kRepeat : Wrap::kClamp;
}

/// One conversion: assimp's scene on one side, ours on the other.
class Conversion {
 public:
  Conversion(const std::filesystem::path& path, const aiScene& source, Loaded& target)
      : path_(path),
        source_(source),
        scene_(target.scene),
        report_(target.report),
        textures_(target.scene, target.report) {}

  void run() {
    for (unsigned i = 0; i < source_.mNumMaterials; ++i) add_material(*source_.mMaterials[i]);
    if (scene_.materials.empty()) scene_.materials.emplace_back();
    for (unsigned i = 0; i < source_.mNumMeshes; ++i) add_mesh(*source_.mMeshes[i]);
    if (dropped_ > 0) report_.warn(fmt::format("{} points and lines left out", dropped_));
    if (source_.mRootNode != nullptr) add_nodes();
  }

 private:
  std::optional<TextureId> texture(const aiMaterial& material, aiTextureType type) {
    aiString name;
    aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap,
                                 aiTextureMapMode_Wrap};
    if (material.GetTexture(type, 0, &name, nullptr, nullptr, nullptr, nullptr, modes) !=
        aiReturn_SUCCESS) {
      return std::nullopt;
    }
    const Wrap u = to_wrap(modes[0]), v = to_wrap(modes[1]);
    if (const aiTexture* embedded = source_.GetEmbeddedTexture(name.C_Str())) {
      if (embedded->mHeight != 0) {
        ++report_.unknown["embedded texture without a file format"];
        return std::nullopt;
      }
      const std::span bytes(reinterpret_cast<const std::byte*>(embedded->pcData), embedded->mWidth);
      return textures_.load_bytes(bytes, path_.string() + ": texture " + to_text(name), u, v);
    }
    std::string file = to_text(name);
    std::replace(file.begin(), file.end(), '\\', '/');
    return textures_.load(path_.parent_path() / file, u, v);
  }

  std::optional<TextureId> texture(const aiMaterial& material, aiTextureType type,
                                   aiTextureType otherwise) {
    const auto id = texture(material, type);
    return id ? id : texture(material, otherwise);
  }

  void add_material(const aiMaterial& source) {
    Material& material = scene_.materials.emplace_back();
    material.name = to_text(source.GetName());
    aiColor3D colour;
    if (source.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
        source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) {
      material.reflectance = to_rgb(colour);
    }
    material.reflectance_texture = texture(source, aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR);
    if (source.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS) {
      material.emission = to_rgb(colour);
    }
    float intensity = 1.0f;
    if (source.Get(AI_MATKEY_EMISSIVE_INTENSITY, intensity) == aiReturn_SUCCESS) {
      material.emission *= intensity;
    }
    material.emission_texture =
        texture(source, aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR);
    // A picture of a lamp without a colour for it is meant to shine as it is.
    if (material.emission_texture && is_black(material.emission)) material.emission = Rgb(1.0f);
    if (source.Get(AI_MATKEY_COLOR_SPECULAR, colour) == aiReturn_SUCCESS) {
      material.specular = to_rgb(colour);
    }
    source.Get(AI_MATKEY_SHININESS, material.shininess);
    source.Get(AI_MATKEY_OPACITY, material.opacity);
    material.blend = material.opacity < 1.0f;
    int two_sided = 0;
    source.Get(AI_MATKEY_TWOSIDED, two_sided);
    material.double_sided = two_sided != 0;
  }

  void add_mesh(const aiMesh& source) {
    std::optional<MeshId>& id = mesh_of_.emplace_back();
    // Polygons that were cut into triangles carry a flag beside the triangles'.
    if (!(source.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) {
      dropped_ += source.mNumFaces;
      return;
    }
    id = to_id<MeshId>(scene_.meshes.size());
    Mesh& mesh = scene_.meshes.emplace_back();
    mesh.name = to_text(source.mName);
    mesh.material = to_id<MaterialId>(
        std::min<std::size_t>(source.mMaterialIndex, scene_.materials.size() - 1));
    const std::size_t count = source.mNumVertices;
    mesh.positions.reserve(count);
    for (std::size_t i = 0; i < count; ++i) mesh.positions.push_back(to_vec3(source.mVertices[i]));
    if (source.HasNormals()) {
      mesh.normals.reserve(count);
      for (std::size_t i = 0; i < count; ++i) mesh.normals.push_back(to_vec3(source.mNormals[i]));
    }
    if (source.HasTextureCoords(0)) {
      mesh.texcoords.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        // In assimp v = 0 is the last row.
        const aiVector3D& t = source.mTextureCoords[0][i];
        mesh.texcoords.push_back({t.x, 1.0f - t.y});
      }
    }
    if (source.HasVertexColors(0)) {
      scene_.materials[index(mesh.material)].vertex_colours = true;
      mesh.colours.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        const aiColor4D& c = source.mColors[0][i];
        mesh.colours.push_back({c.r, c.g, c.b, c.a});
      }
    }
    mesh.triangles.reserve(source.mNumFaces);
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
      const aiFace& face = source.mFaces[i];
      if (face.mNumIndices != 3) continue;
      mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
    }
  }

  void add_nodes() {
    struct Visit {
      const aiNode* node;
      Mat4 to_world;
    };
    std::vector<Visit> pending{{source_.mRootNode, to_mat4(source_.mRootNode->mTransformation)}};
    while (!pending.empty()) {
      const auto [node, to_world] = pending.back();
      pending.pop_back();
      for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        const unsigned mesh = node->mMeshes[i];
        if (mesh < mesh_of_.size() && mesh_of_[mesh]) {
          scene_.instances.push_back({*mesh_of_[mesh], to_world, std::nullopt});
        }
      }
      for (unsigned i = 0; i < source_.mNumCameras; ++i) {
        const aiCamera& camera = *source_.mCameras[i];
        if (camera.mName == node->mName) add_camera(camera, to_world);
      }
      for (unsigned i = 0; i < source_.mNumLights; ++i) {
        const aiLight& light = *source_.mLights[i];
        if (light.mName == node->mName) add_light(light, to_world);
      }
      for (unsigned i = node->mNumChildren; i-- > 0;) {
        const aiNode* child = node->mChildren[i];
        pending.push_back({child, to_world * to_mat4(child->mTransformation)});
      }
    }
  }

  void add_camera(const aiCamera& source, const Mat4& to_world) {
    if (source.mOrthographicWidth > 0.0f) {
      ++report_.unknown["orthographic camera"];
      return;
    }
    Camera& camera = scene_.cameras.emplace_back();
    camera.name = to_text(source.mName);
    camera.eye = Vec3(to_world * Vec4(to_vec3(source.mPosition), 1.0f));
    camera.forward = glm::normalize(Mat3(to_world) * to_vec3(source.mLookAt));
    camera.up = glm::normalize(Mat3(to_world) * to_vec3(source.mUp));
    // assimp 5.2 finds no COLLADA optics and leaves 0.8 degrees, by its default taken for degrees.
    constexpr float kNarrowest = 0.015f;
    if (source.mHorizontalFOV < kNarrowest) {
      report_.warn(fmt::format("camera '{}': its field of view was not read", camera.name));
    } else {
      const float aspect = source.mAspect > 0.0f ? source.mAspect : 1.0f;
      camera.vertical_fov = 2.0f * std::atan(std::tan(0.5f * source.mHorizontalFOV) / aspect);
    }
  }

  void add_light(const aiLight& source, const Mat4& to_world) {
    PunctualLight light;
    light.name = to_text(source.mName);
    light.intensity = to_rgb(source.mColorDiffuse);
    light.position = Vec3(to_world * Vec4(to_vec3(source.mPosition), 1.0f));
    switch (source.mType) {
      case aiLightSource_POINT:
        light.kind = PunctualKind::kPoint;
        break;
      case aiLightSource_SPOT:
        light.kind = PunctualKind::kSpot;
        // assimp's cones are whole angles.
        light.inner_angle = 0.5f * source.mAngleInnerCone;
        light.outer_angle = 0.5f * source.mAngleOuterCone;
        break;
      case aiLightSource_DIRECTIONAL:
        light.kind = PunctualKind::kDirectional;
        break;
      default:
        ++report_.unknown["ambient or area light"];
        return;
    }
    if (light.kind != PunctualKind::kPoint) {
      light.direction = glm::normalize(Mat3(to_world) * to_vec3(source.mDirection));
    }
    scene_.lights.push_back(std::move(light));
  }

  const std::filesystem::path& path_;
  const aiScene& source_;
  Scene& scene_;
  LoadReport& report_;
  TextureCache textures_;
  std::vector<std::optional<MeshId>> mesh_of_;  // by assimp's mesh; none: not of triangles
  std::size_t dropped_ = 0;
};

}  // namespace

Loaded load_assimp(const std::filesystem::path& path, const LoadOptions&) {
  const Place place{path.string()};
  std::error_code code;
  if (!std::filesystem::exists(path, code)) fail(place, "no such file");
  if (!std::filesystem::is_regular_file(path, code)) fail(place, "is not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (size > kLargestFile) fail(place, "has {} bytes; the limit is {}", size, kLargestFile);

  Loaded loaded;
  try {
    Assimp::Importer importer;
    importer.SetIOHandler(new ReadOnlyFiles);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    if (!importer.IsExtensionSupported(extension(path))) {
      fail(place,
           "its format is unknown; Ogre's .mesh.xml, .mesh and .scene are read, glTF, OBJ and "
           "what else assimp reads");
    }
    const aiScene* source =
        importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType);
    if (source == nullptr) fail(place, "{}", importer.GetErrorString());
    const int format = importer.GetPropertyInteger("importerIndex", -1);
    if (const aiImporterDesc* desc =
            format < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(format))) {
      loaded.report.format = desc->mName;
    }
    Conversion(path, *source, loaded).run();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail(place, "{}", e.what());
  }
  return loaded;
}

}  // namespace lantern
