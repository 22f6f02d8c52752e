// SPDX-License-Identifier: MIT
#include "lantern/load/gltf_scene.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/load/textures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace lantern {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::byte>;

/// Vertices and indices of all primitives together: a small file may name one accessor in many of
/// them, and this bounds the memory to some GiB.
constexpr std::size_t kMostElements = std::size_t{1} << 27;

/// Above this, a number of JSON need not be an exact integer.
constexpr double kMostExact = 9007199254740992.0;

std::uint32_t little_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  return value;
}

template <typename T>
T read_as(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

std::optional<Bytes> decode_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::byte>((bits >> count) & 0xff));
    }
  }
  return bytes;
}

/// "%20" -> " " [RFC 3986, 2.1]
std::string decode_percent(std::string_view uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape =
        uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0;
    text += escape ? static_cast<char>(16 * hex(uri[i + 1]) + hex(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return text;
}

/// The JSON of a file and the binary chunk that a GLB has beside it.
struct Document {
  Json json;
  Bytes binary;
};

Json parse_json(std::span<const std::byte> bytes, const std::string& file) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    // nlohmann's byte counts from 1.
    const std::string_view before = text.substr(0, std::min(text.size(), e.byte));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_start = before.rfind('\n');
    const std::size_t column =
        before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1);
    fail({file, static_cast<int>(line), static_cast<int>(column)}, "is not valid JSON here");
  }
}

Document read_document(const std::filesystem::path& path) {
  constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const std::string file = path.string();
  const Bytes bytes = read_file(path);
  const std::span<const std::byte> all(bytes);
  if (all.size() < 4 || little_endian(all) != kMagic) return {parse_json(all, file), {}};

  if (all.size() < kHeader) fail({.file = file, .byte = all.size()}, "the GLB header is cut off");
  if (const auto version = little_endian(all.subspan(4)); version != 2) {
    fail({.file = file, .byte = 4}, "is GLB {}; only version 2 is read", version);
  }
  const std::size_t length = little_endian(all.subspan(8));
  if (length < kHeader || length > all.size()) {
    fail({.file = file, .byte = 8}, "claims {} bytes but has {}", length, all.size());
  }
  Document document;
  bool has_json = false, has_binary = false;
  for (std::size_t at = kHeader; at < length;) {
    if (length - at < kChunkHeader) fail({.file = file, .byte = at}, "a chunk is cut off");
    const std::size_t size = little_endian(all.subspan(at));
    const std::uint32_t type = little_endian(all.subspan(at + 4));
    if (size > length - at - kChunkHeader) {
      fail({.file = file, .byte = at}, "a chunk claims {} bytes; {} are left", size,
           length - at - kChunkHeader);
    }
    const auto chunk = all.subspan(at + kChunkHeader, size);
    if (type == kJson && !has_json) {
      document.json = parse_json(chunk, file);
      has_json = true;
    } else if (type == kBinary && !has_binary) {
      document.binary.assign(chunk.begin(), chunk.end());
      has_binary = true;
    }
    at += kChunkHeader + size;
  }
  if (!has_json) fail({.file = file, .byte = kHeader}, "has no JSON chunk");
  return document;
}

/// Numbers laid out as an accessor says; components become floats, normalised where it asks.
struct View {
  const std::byte* data = nullptr;  // null: all zero
  std::size_t count = 0;
  std::size_t stride = 0;
  std::size_t components = 0;
  std::size_t component_type = 0;
  std::size_t component_size = 0;
  bool normalized = false;

  float component(std::size_t element, std::size_t c) const {
    if (data == nullptr) return 0.0f;
    const std::byte* at = data + element * stride + c * component_size;
    const auto scaled = [&](auto value) {
      const auto f = static_cast<float>(value);
      constexpr auto kLargest = static_cast<float>(std::numeric_limits<decltype(value)>::max());
      return normalized ? std::max(f / kLargest, -1.0f) : f;
    };
    switch (component_type) {
      case 5120:
        return scaled(read_as<std::int8_t>(at));
      case 5121:
        return scaled(read_as<std::uint8_t>(at));
      case 5122:
        return scaled(read_as<std::int16_t>(at));
      case 5123:
        return scaled(read_as<std::uint16_t>(at));
      case 5125:
        return scaled(read_as<std::uint32_t>(at));
      default:
        return read_as<float>(at);
    }
  }

  std::uint32_t index(std::size_t element) const {
    if (data == nullptr) return 0;
    const std::byte* at = data + element * stride;
    if (component_size == 1) return read_as<std::uint8_t>(at);
    return component_size == 2 ? read_as<std::uint16_t>(at) : read_as<std::uint32_t>(at);
  }

  template <typename Vec>
  Vec vec(std::size_t element) const {
    Vec v(1.0f);  // what a colour without alpha has for it
    const auto size = std::min(components, static_cast<std::size_t>(Vec::length()));
    for (std::size_t c = 0; c < size; ++c) {
      v[static_cast<int>(c)] = component(element, c);
    }
    return v;
  }
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, Document document, Loaded& target)
      : path_(path),
        place_{path.string()},
        json_(std::move(document.json)),
        binary_(std::move(document.binary)),
        scene_(target.scene),
        report_(target.report),
        textures_(target.scene, target.report) {}

  void run() {
    if (!json_.is_object()) fail(place_, "is not a glTF document");
    const std::string version = text(member(json_, "asset"), "version");
    if (!version.starts_with("2.")) fail(place_, "is glTF '{}'; only 2.0 is read", version);
    check_extensions();
    buffers_.resize(size("buffers"));
    meshes_.resize(size("meshes"));
    for (std::size_t i = 0; i < size("materials"); ++i) add_material(i);
    add_nodes();
    if (dropped_ > 0)
      report_.warn(fmt::format("{} primitives of points or lines left out", dropped_));
  }

 private:
  // --- JSON, with the object at fault in every message -------------------------------------------

  template <typename... Args>
  [[noreturn]] void fault(fmt::format_string<Args...> text, Args&&... args) const {
    const std::string message = fmt::format(text, std::forward<Args>(args)...);
    fail(place_, "{}{}{}", where_, where_.empty() ? "" : ": ", message);
  }

  /// The member `key`, an empty object if there is none; it must be an object or an array.
  const Json& member(const Json& object, const char* key) const {
    static const Json kNone = Json::object();
    const auto found = object.find(key);
    if (found == object.end()) return kNone;
    if (!found->is_structured()) fault("'{}' is no object", key);
    return *found;
  }

  const Json& extension_of(const Json& object, const char* name) const {
    return member(member(object, "extensions"), name);
  }

  std::string text(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return "";
    if (!found->is_string()) fault("'{}' is no text", key);
    return found->get<std::string>();
  }

  bool flag(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return false;
    if (!found->is_boolean()) fault("'{}' is neither true nor false", key);
    return found->get<bool>();
  }

  float number(const Json& object, const char* key, float otherwise) const {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_number()) fault("'{}' is no number", key);
    return static_cast<float>(found->get<double>());
  }

  std::size_t to_count(const Json& value, const char* key) const {
    const double number = value.is_number() ? value.get<double>() : -1.0;
    if (!(number >= 0.0 && number <= kMostExact) || number != std::floor(number)) {
      fault("'{}' is no index or count", key);
    }
    return static_cast<std::size_t>(number);
  }

  std::optional<std::size_t> count(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    return to_count(*found, key);
  }

  std::size_t required(const Json& object, const char* key) const {
    const auto value = count(object, key);
    if (!value) fault("has no '{}'", key);
    return *value;
  }

  template <typename Vec>
  Vec vec(const Json& object, const char* key, Vec otherwise) const {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    Vec v;
    const auto length = static_cast<std::size_t>(Vec::length());
    if (!found->is_array() || found->size() != length) fault("'{}' is not {} numbers", key, length);
    for (std::size_t c = 0; c < length; ++c) {
      if (!(*found)[c].is_number()) fault("'{}' is not {} numbers", key, length);
      v[static_cast<int>(c)] = static_cast<float>((*found)[c].get<double>());
    }
    return v;
  }

  /// How many elements a list of the document has.
  std::size_t size(const char* list) const {
    const Json& elements = member(json_, list);
    if (!elements.is_array() && !elements.empty()) fault("'{}' is no list", list);
    return elements.size();
  }

  const Json& element(const Json& list, const char* name, std::size_t i) const {
    if (!list.is_array() || i >= list.size()) fault("there is no {}[{}]", name, i);
    if (!list[i].is_object()) fault("{}[{}] is no object", name, i);
    return list[i];
  }
  const Json& element(const char* list, std::size_t i) const {
    return element(member(json_, list), list, i);
  }

  /// Names the object that faults are about while it lives.
  class About {
   public:
    About(Reader& reader, const char* list, std::size_t i)
        : reader_(reader), before_(std::exchange(reader.where_, fmt::format("{}[{}]", list, i))) {}
    About(const About&) = delete;
    About& operator=(const About&) = delete;
    ~About() { reader_.where_ = std::move(before_); }

   private:
    Reader& reader_;
    std::string before_;
  };

  void check_extensions() {
    static const std::set<std::string> kRead = {"KHR_lights_punctual",
                                                "KHR_materials_emissive_strength",
                                                "KHR_mesh_quantization", "KHR_texture_transform"};
    // These change how light is reflected, which a Lambertian surface leaves out anyway.
    const auto only_looks = [](const std::string& name) {
      return name.starts_with("KHR_materials_") && name != "KHR_materials_pbrSpecularGlossiness";
    };
    for (const Json& name : member(json_, "extensionsRequired")) {
      if (!name.is_string()) fault("'extensionsRequired' is no list of names");
      const auto required = name.get<std::string>();
      if (!kRead.contains(required) && !only_looks(required)) {
        fault("needs the extension {}, which is not read", required);
      }
    }
    for (const Json& name : member(json_, "extensionsUsed")) {
      if (!name.is_string()) fault("'extensionsUsed' is no list of names");
      if (!kRead.contains(name.get<std::string>())) ++report_.unknown[name.get<std::string>()];
    }
    for (const char* list : {"skins", "animations"}) {
      if (const auto n = size(list)) report_.unknown[list] += static_cast<int>(n);
    }
  }

  // --- Binary data -------------------------------------------------------------------------------

  Bytes read_uri(const std::string& uri) const {
    if (!uri.starts_with("data:")) return read_file(path_.parent_path() / decode_percent(uri));
    constexpr std::string_view kBase64 = ";base64,";
    const std::size_t at = uri.find(kBase64);
    auto bytes = at == std::string::npos
                     ? std::nullopt
                     : decode_base64(std::string_view(uri).substr(at + kBase64.size()));
    if (!bytes) fault("its data: URI is not base64");
    return *std::move(bytes);
  }

  std::span<const std::byte> buffer(std::size_t i) {
    const About about(*this, "buffers", i);
    const Json& source = element("buffers", i);
    if (!buffers_[i]) {
      const std::string uri = text(source, "uri");
      // The binary chunk of a GLB is the buffer without an address.
      buffers_[i] = uri.empty() ? binary_ : read_uri(uri);
      const std::size_t claimed = required(source, "byteLength");
      if (claimed > buffers_[i]->size()) {
        fault("claims {} bytes but has {}", claimed, buffers_[i]->size());
      }
    }
    return *buffers_[i];
  }

  std::span<const std::byte> buffer_view(std::size_t i) {
    const About about(*this, "bufferViews", i);
    const Json& source = element("bufferViews", i);
    const auto bytes = buffer(required(source, "buffer"));
    const std::size_t offset = count(source, "byteOffset").value_or(0);
    const std::size_t length = required(source, "byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset) {
      fault("reaches beyond its buffer");
    }
    return bytes.subspan(offset, length);
  }

  View accessor(std::size_t i) {
    const About about(*this, "accessors", i);
    const Json& source = element("accessors", i);
    static const std::map<std::string, std::size_t> kComponents = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    static const std::map<std::size_t, std::size_t> kSizes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                              {5123, 2}, {5125, 4}, {5126, 4}};
    const auto components = kComponents.find(text(source, "type"));
    if (components == kComponents.end()) fault("its type is not one that a mesh can have");
    const auto size = kSizes.find(required(source, "componentType"));
    if (size == kSizes.end()) fault("its componentType is unknown");

    View view;
    view.components = components->second;
    view.component_type = size->first;
    view.component_size = size->second;
    view.normalized = flag(source, "normalized");
    view.count = required(source, "count");
    if (source.contains("sparse")) fault("is sparse, which is not read");
    const auto backing = count(source, "bufferView");
    if (!backing) return view;

    const auto bytes = buffer_view(*backing);
    const std::size_t element_size = view.components * view.component_size;
    view.stride = count(element("bufferViews", *backing), "byteStride").value_or(element_size);
    const std::size_t offset = count(source, "byteOffset").value_or(0);
    if (view.stride < element_size) fault("its elements overlap");
    if (view.count > 0 && (offset > bytes.size() || bytes.size() - offset < element_size ||
                           (bytes.size() - offset - element_size) / view.stride < view.count - 1)) {
      fault("its {} elements reach beyond its bufferView", view.count);
    }
    view.data = bytes.data() + offset;
    return view;
  }

  // --- Materials ---------------------------------------------------------------------------------

  /// A textureInfo's texture; none where only an extension that is not read says where it is.
  std::optional<TextureId> texture(const Json& info) {
    const auto i = count(info, "index");
    if (!i) return std::nullopt;
    const About about(*this, "textures", *i);
    const Json& source = element("textures", *i);
    const auto to_wrap = [&](std::size_t mode) {
      if (mode == 33071) return Wrap::kClamp;
      return mode == 33648 ? Wrap::kMirror : Wrap::kRepeat;
    };
    Wrap u = Wrap::kRepeat, v = Wrap::kRepeat;
    if (const auto sampler = count(source, "sampler")) {
      const Json& s = element("samplers", *sampler);
      u = to_wrap(count(s, "wrapS").value_or(0));
      v = to_wrap(count(s, "wrapT").value_or(0));
    }
    const auto image = count(source, "source");
    if (!image) return std::nullopt;
    const About about_image(*this, "images", *image);
    const Json& picture = element("images", *image);
    const std::string name = fmt::format("{}: images[{}]", place_.file, *image);
    if (const auto view = count(picture, "bufferView")) {
      return textures_.load_bytes(buffer_view(*view), name, u, v);
    }
    const std::string uri = text(picture, "uri");
    if (uri.starts_with("data:")) return textures_.load_bytes(read_uri(uri), name, u, v);
    if (uri.empty()) fault("has neither 'uri' nor 'bufferView'");
    return textures_.load(path_.parent_path() / decode_percent(uri), u, v);
  }

  void add_material(std::size_t i) {
    const About about(*this, "materials", i);
    const Json& source = element("materials", i);
    const Json& pbr = member(source, "pbrMetallicRoughness");
    Material material;
    material.name = text(source, "name");
    const Vec4 base = vec(pbr, "baseColorFactor", Vec4(1.0f));
    material.reflectance = Rgb(base);
    material.reflectance_texture = texture(member(pbr, "baseColorTexture"));
    material.emission =
        vec(source, "emissiveFactor", Rgb(0.0f)) *
        number(extension_of(source, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0f);
    material.emission_texture = texture(member(source, "emissiveTexture"));
    material.double_sided = flag(source, "doubleSided");
    const std::string mode = text(source, "alphaMode");
    if (mode == "MASK" || mode == "BLEND") material.opacity = base.a;
    material.blend = mode == "BLEND";
    if (mode == "MASK") material.alpha_cutoff = number(source, "alphaCutoff", 0.5f);
    scene_.materials.push_back(std::move(material));
  }

  /// What takes primitives without a material; made once it is needed.
  MaterialId default_material() {
    if (!default_material_) {
      default_material_ = to_id<MaterialId>(scene_.materials.size());
      Material material;
      material.name = "default";
      material.reflectance = Rgb(1.0f);
      scene_.materials.push_back(std::move(material));
    }
    return *default_material_;
  }

  /// Which texture coordinates a material's pictures use and how they are moved. A mesh has one
  /// set, so that of the base colour wins.
  struct TexcoordUse {
    std::size_t set = 0;
    glm::mat3x2 transform{1.0f};
  };

  TexcoordUse texcoord_use(const Json& info) const {
    TexcoordUse use;
    const Json& moved = extension_of(info, "KHR_texture_transform");
    use.set = count(moved, "texCoord").value_or(count(info, "texCoord").value_or(0));
    const Vec2 offset = vec(moved, "offset", Vec2(0.0f)), scale = vec(moved, "scale", Vec2(1.0f));
    const float angle = number(moved, "rotation", 0.0f);
    const float c = std::cos(angle), s = std::sin(angle);
    use.transform = glm::mat3x2(Vec2(c, -s) * scale.x, Vec2(s, c) * scale.y, offset);
    return use;
  }

  TexcoordUse texcoord_use_of_material(std::size_t i) {
    const About about(*this, "materials", i);
    const Json& source = element("materials", i);
    const Json& base = member(member(source, "pbrMetallicRoughness"), "baseColorTexture");
    const Json& emissive = member(source, "emissiveTexture");
    if (emissive.empty()) return texcoord_use(base);
    const TexcoordUse of_emissive = texcoord_use(emissive);
    if (base.empty()) return of_emissive;
    const TexcoordUse of_base = texcoord_use(base);
    if (of_base.set != of_emissive.set || of_base.transform != of_emissive.transform) {
      report_.warn("an emissive texture is placed as the base colour's is");
    }
    return of_base;
  }

  // --- Meshes ------------------------------------------------------------------------------------

  /// Corners of the triangles in the order of the file; empty for points and lines.
  std::vector<uvec3> triangles_of(const std::vector<std::uint32_t>& v, std::size_t mode) {
    std::vector<uvec3> triangles;
    switch (mode) {
      case 4:
        for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
          triangles.push_back({v[i], v[i + 1], v[i + 2]});
        }
        break;
      case 5:
        for (std::size_t i = 0; i + 2 < v.size(); ++i) {
          triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        }
        break;
      case 6:
        for (std::size_t i = 1; i + 1 < v.size(); ++i) triangles.push_back({v[i], v[i + 1], v[0]});
        break;
      default:
        ++dropped_;
    }
    return triangles;
  }

  void spend(std::size_t elements) {
    elements_left_ -= std::min(elements, elements_left_);
    if (elements_left_ == 0) fault("more than {} vertices and indices", kMostElements);
  }

  /// The attribute `name` of the vertices `used`; empty if the primitive has none.
  template <typename Vec>
  std::vector<Vec> attribute(const Json& attributes, const std::string& name,
                             const std::vector<std::uint32_t>& used, std::size_t vertices,
                             std::size_t fewest_components) {
    std::vector<Vec> values;
    const auto i = count(attributes, name.c_str());
    if (!i) return values;
    const View view = accessor(*i);
    if (view.count != vertices) {
      fault("{} has {} values for {} vertices", name, view.count, vertices);
    }
    if (view.components < fewest_components) fault("{} has too few components", name);
    values.reserve(used.size());
    for (std::uint32_t v : used) values.push_back(view.vec<Vec>(v));
    return values;
  }

  std::optional<MeshId> add_primitive(const Json& source, const std::string& name) {
    const Json& attributes = member(source, "attributes");
    const auto positions = count(attributes, "POSITION");
    if (!positions) {
      ++report_.unknown["primitive without POSITION"];
      return std::nullopt;
    }
    const std::size_t vertices = accessor(*positions).count;
    spend(vertices);
    std::vector<std::uint32_t> order;
    if (const auto indices = count(source, "indices")) {
      const View view = accessor(*indices);
      spend(view.count);
      const bool is_unsigned =
          view.component_type == 5121 || view.component_type == 5123 || view.component_type == 5125;
      if (!is_unsigned || view.components != 1) fault("its indices are no unsigned integers");
      order.reserve(view.count);
      for (std::size_t i = 0; i < view.count; ++i) order.push_back(view.index(i));
    } else {
      for (std::size_t i = 0; i < vertices; ++i) order.push_back(static_cast<std::uint32_t>(i));
    }
    const auto outside =
        std::find_if(order.begin(), order.end(), [&](std::uint32_t v) { return v >= vertices; });
    if (outside != order.end()) fault("index {} of {} vertices", *outside, vertices);

    Mesh mesh;
    mesh.name = name;
    mesh.triangles = triangles_of(order, count(source, "mode").value_or(4));
    if (mesh.triangles.empty()) return std::nullopt;

    // Exporters share one vertex array between many primitives: each takes what it uses.
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> place_of(vertices, kUnused), used;
    for (std::uint32_t v : order) place_of[v] = 0;
    for (std::uint32_t v = 0; v < vertices; ++v) {
      if (place_of[v] == kUnused) continue;
      place_of[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(v);
    }
    for (uvec3& t : mesh.triangles) t = {place_of[t.x], place_of[t.y], place_of[t.z]};

    const auto material = count(source, "material");
    if (material && *material >= size("materials")) fault("there is no materials[{}]", *material);
    mesh.material = material ? to_id<MaterialId>(*material) : default_material();
    mesh.positions = attribute<Vec3>(attributes, "POSITION", used, vertices, 3);
    mesh.normals = attribute<Vec3>(attributes, "NORMAL", used, vertices, 3);
    const TexcoordUse use = material ? texcoord_use_of_material(*material) : TexcoordUse{};
    mesh.texcoords =
        attribute<Vec2>(attributes, fmt::format("TEXCOORD_{}", use.set), used, vertices, 2);
    for (Vec2& t : mesh.texcoords) t = use.transform * Vec3(t, 1.0f);
    mesh.colours = attribute<Vec4>(attributes, "COLOR_0", used, vertices, 3);
    if (!mesh.colours.empty()) scene_.materials[index(mesh.material)].vertex_colours = true;

    const auto id = to_id<MeshId>(scene_.meshes.size());
    scene_.meshes.push_back(std::move(mesh));
    return id;
  }

  const std::vector<MeshId>& mesh(std::size_t i) {
    const About about(*this, "meshes", i);
    const Json& source = element("meshes", i);
    if (!meshes_[i]) {
      std::vector<MeshId>& ids = meshes_[i].emplace();
      const Json& primitives = member(source, "primitives");
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        const auto id = add_primitive(element(primitives, "primitives", p), text(source, "name"));
        if (id) ids.push_back(*id);
      }
    }
    return *meshes_[i];
  }

  // --- Nodes -------------------------------------------------------------------------------------

  Mat4 local_transform(const Json& node) const {
    if (node.contains("matrix")) {
      Mat4 m;
      const Json& values = member(node, "matrix");
      if (!values.is_array() || values.size() != 16) fault("'matrix' is not 16 numbers");
      for (std::size_t i = 0; i < 16; ++i) {
        if (!values[i].is_number()) fault("'matrix' is not 16 numbers");
        m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] =
            static_cast<float>(values[i].get<double>());
      }
      return m;
    }
    const Vec4 r = vec(node, "rotation", Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    return glm::translate(Mat4(1.0f), vec(node, "translation", Vec3(0.0f))) *
           glm::mat4_cast(Quat(r.w, r.x, r.y, r.z)) *
           glm::scale(Mat4(1.0f), vec(node, "scale", Vec3(1.0f)));
  }

  std::vector<std::size_t> indices(const Json& object, const char* key) const {
    std::vector<std::size_t> values;
    for (const Json& value : member(object, key)) values.push_back(to_count(value, key));
    return values;
  }

  /// The roots of the default scene, of the first one, or the nodes that are no one's children.
  std::vector<std::size_t> roots() const {
    if (size("scenes") > 0) {
      return indices(element("scenes", count(json_, "scene").value_or(0)), "nodes");
    }
    std::vector<bool> is_child(size("nodes"), false);
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      for (std::size_t child : indices(element("nodes", i), "children")) {
        if (child < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) result.push_back(i);
    }
    return result;
  }

  void add_nodes() {
    struct Visit {
      std::size_t node;
      Mat4 parent_to_world;
    };
    std::vector<Visit> pending;
    const auto add = [&](const std::vector<std::size_t>& nodes, const Mat4& to_world) {
      for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) pending.push_back({*i, to_world});
    };
    std::vector<bool> seen(size("nodes"), false);
    add(roots(), Mat4(1.0f));
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      const Json& node = element("nodes", visit.node);
      const About about(*this, "nodes", visit.node);
      if (seen[visit.node]) fault("has two parents or is its own ancestor");
      seen[visit.node] = true;
      const Mat4 to_world = visit.parent_to_world * local_transform(node);
      if (const auto i = count(node, "mesh")) {
        for (MeshId id : mesh(*i)) scene_.instances.push_back({id, to_world, std::nullopt});
      }
      if (const auto i = count(node, "camera")) add_camera(*i, node, to_world);
      if (const auto i = count(extension_of(node, "KHR_lights_punctual"), "light")) {
        add_light(*i, node, to_world);
      }
      add(indices(node, "children"), to_world);
    }
  }

  void add_camera(std::size_t i, const Json& node, const Mat4& to_world) {
    const About about(*this, "cameras", i);
    const Json& source = element("cameras", i);
    if (text(source, "type") != "perspective") {
      ++report_.unknown["orthographic camera"];
      return;
    }
    Camera camera;
    camera.name = text(node, "name").empty() ? text(source, "name") : text(node, "name");
    camera.eye = Vec3(to_world[3]);
    camera.forward = -glm::normalize(Vec3(to_world[2]));
    camera.up = glm::normalize(Vec3(to_world[1]));
    camera.vertical_fov = number(member(source, "perspective"), "yfov", camera.vertical_fov);
    scene_.cameras.push_back(std::move(camera));
  }

  void add_light(std::size_t i, const Json& node, const Mat4& to_world) {
    const About about(*this, "lights", i);
    const Json& source =
        element(member(extension_of(json_, "KHR_lights_punctual"), "lights"), "lights", i);
    PunctualLight light;
    light.name = text(node, "name").empty() ? text(source, "name") : text(node, "name");
    light.intensity = vec(source, "color", Rgb(1.0f)) * number(source, "intensity", 1.0f);
    light.position = Vec3(to_world[3]);
    light.direction = -glm::normalize(Vec3(to_world[2]));
    const std::string type = text(source, "type");
    if (type == "spot") {
      light.kind = PunctualKind::kSpot;
      const Json& spot = member(source, "spot");
      light.inner_angle = number(spot, "innerConeAngle", 0.0f);
      light.outer_angle = number(spot, "outerConeAngle", 0.25f * kPi);
    } else if (type == "directional") {
      light.kind = PunctualKind::kDirectional;
    } else if (type != "point") {
      fault("its type '{}' is unknown", type);
    }
    scene_.lights.push_back(std::move(light));
  }

  const std::filesystem::path& path_;
  const Place place_;
  const Json json_;
  const Bytes binary_;
  Scene& scene_;
  LoadReport& report_;
  TextureCache textures_;
  std::string where_;
  std::vector<std::optional<Bytes>> buffers_;
  std::vector<std::optional<std::vector<MeshId>>> meshes_;  // by the file's mesh: one a primitive
  std::optional<MaterialId> default_material_;
  std::size_t elements_left_ = kMostElements;
  std::size_t dropped_ = 0;
};

}  // namespace

Loaded load_gltf(const std::filesystem::path& path, const LoadOptions&) {
  Loaded loaded;
  loaded.report.format = extension(path) == ".glb" ? "glTF 2.0, binary" : "glTF 2.0";
  try {
    Reader(path, read_document(path), loaded).run();
  } catch (const Json::exception& e) {
    fail({path.string()}, "{}", e.what());
  }
  return loaded;
}

}  // namespace lantern
