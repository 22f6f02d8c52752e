// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_binary.h"

#include "lantern/core/file.h"
#include "lantern/load/ogre_text.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstring>
#include <string_view>
#include <utility>

namespace lantern {
namespace ogre {
namespace {

// The formats differ in what a scene at rest leaves out: 1.40 changed edge lists, 1.41 and 1.8
// poses and morphs (normals), 1.8 and 1.100 levels of detail. In all of them submeshes and geometry
// are written alike; 1.10 and 1.20 had no vertex declarations.
constexpr std::array<std::string_view, 5> kVersions{"1.30", "1.40", "1.41", "1.8", "1.100"};

enum Chunk : std::uint16_t {
  kHeader = 0x1000,
  kMesh = 0x3000,
  kSubmesh = 0x4000,
  kOperation = 0x4010,
  kSubmeshBones = 0x4100,
  kTextureAlias = 0x4200,
  kGeometry = 0x5000,
  kDeclaration = 0x5100,
  kElement = 0x5110,
  kVertexBuffer = 0x5200,
  kVertexData = 0x5210,
  kNameTable = 0xA000,
  kName = 0xA100,
};

/// Skeleton link, bones, levels of detail, bounds, edge lists, poses, animations, extremes.
constexpr std::array<std::uint16_t, 8> kLeftOut{0x6000, 0x7000, 0x8000, 0x9000,
                                                0xB000, 0xC000, 0xD000, 0xE000};

constexpr std::size_t kChunkHead = 6;  // id and length, which counts these bytes too

/// VertexElementSemantic of Ogre.
enum Semantic : std::uint16_t { kPosition = 1, kNormal = 4, kDiffuse = 5, kTexcoord = 7 };

enum class Component {
  kFloat,
  kDouble,
  kHalf,
  kShort,
  kUnsignedShort,
  kShortNorm,
  kUnsignedShortNorm,
  kByteNorm,
  kUnsignedByteNorm,
  kTenBits,  // 10, 10, 10, 2 bits from the lowest on, signed and normalised
  kArgb,     // four bytes of one word, from the highest on
  kAbgr,
};

struct Format {
  Component component;
  int count;
};

/// VertexElementType of Ogre: 0-11 since the first format, 12-34 since Ogre 1.10, the ten-bit one
/// since 1.13, halves since 14. Type 4 was the colour of whatever machine wrote the file; it is
/// taken as OpenGL's. None for whole numbers, which only bones use.
std::optional<Format> format_of(std::uint16_t type) {
  switch (type) {
    case 0:
    case 1:
    case 2:
    case 3:
      return Format{Component::kFloat, type + 1};
    case 5:
    case 6:
    case 7:
    case 8:
      return Format{Component::kShort, type - 4};
    case 10:
      return Format{Component::kArgb, 4};
    case 4:
    case 11:
      return Format{Component::kAbgr, 4};
    case 12:
    case 13:
    case 14:
    case 15:
      return Format{Component::kDouble, type - 11};
    case 16:
    case 17:
    case 18:
    case 19:
      return Format{Component::kUnsignedShort, type - 15};
    case 29:
      return Format{Component::kByteNorm, 4};
    case 30:
      return Format{Component::kUnsignedByteNorm, 4};
    case 31:
      return Format{Component::kShortNorm, 2};
    case 32:
      return Format{Component::kShortNorm, 4};
    case 33:
      return Format{Component::kUnsignedShortNorm, 2};
    case 34:
      return Format{Component::kUnsignedShortNorm, 4};
    case 35:
      return Format{Component::kTenBits, 4};
    case 36:
    case 37:
    case 38:
    case 39:
      return Format{Component::kHalf, type - 35};
    default:
      return std::nullopt;
  }
}

std::size_t size_of(const Format& format) {
  const auto count = static_cast<std::size_t>(format.count);
  switch (format.component) {
    case Component::kFloat:
      return 4 * count;
    case Component::kDouble:
      return 8 * count;
    case Component::kHalf:
    case Component::kShort:
    case Component::kUnsignedShort:
    case Component::kShortNorm:
    case Component::kUnsignedShortNorm:
      return 2 * count;
    case Component::kByteNorm:
    case Component::kUnsignedByteNorm:
    case Component::kTenBits:
    case Component::kArgb:
    case Component::kAbgr:
      return 4;
  }
  return 0;
}

bool is_packed_colour(Component c) { return c == Component::kArgb || c == Component::kAbgr; }

/// The bytes of a file, in its byte order, with a place to read on from. Whatever would end beyond
/// the bytes throws.
class Bytes {
 public:
  Bytes(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  Place place(std::size_t at) const { return {name_, std::nullopt, std::nullopt, at}; }
  void go_to(std::size_t at) { at_ = at; }
  void set_order(std::endian order) { swap_ = order != std::endian::native; }

  void require(std::uint64_t size, const char* what) const {
    if (size > left()) {
      fail(place(at_), "{} needs {} bytes where {} are left", what, size, left());
    }
  }

  template <std::integral T>
  T peek_at(std::size_t at) const {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  template <std::integral T>
  T read(const char* what) {
    require(sizeof(T), what);
    const T value = peek_at<T>(at_);
    at_ += sizeof(T);
    return value;
  }

  bool read_bool(const char* what) { return read<std::uint8_t>(what) != 0; }

  /// Strings end with a line feed.
  std::string read_string(const char* what) {
    const auto rest = bytes_.subspan(at_);
    const auto end = std::find(rest.begin(), rest.end(), std::byte{'\n'});
    if (end == rest.end()) fail(place(at_), "{} does not end", what);
    const auto length = static_cast<std::size_t>(end - rest.begin());
    std::string text(length, '\0');
    std::transform(rest.begin(), end, text.begin(),
                   [](std::byte b) { return static_cast<char>(b); });
    at_ += length + 1;
    return text;
  }

  /// Component c of a vertex element.
  float component(std::size_t at, Component component, int c) const {
    const auto i = static_cast<std::size_t>(c);
    switch (component) {
      case Component::kFloat:
        return std::bit_cast<float>(peek_at<std::uint32_t>(at + 4 * i));
      case Component::kDouble:
        return static_cast<float>(std::bit_cast<double>(peek_at<std::uint64_t>(at + 8 * i)));
      case Component::kHalf:
        return glm::unpackHalf1x16(peek_at<std::uint16_t>(at + 2 * i));
      case Component::kShort:
        return peek_at<std::int16_t>(at + 2 * i);
      case Component::kUnsignedShort:
        return peek_at<std::uint16_t>(at + 2 * i);
      case Component::kShortNorm:
        return std::max(static_cast<float>(peek_at<std::int16_t>(at + 2 * i)) / 32767.0f, -1.0f);
      case Component::kUnsignedShortNorm:
        return static_cast<float>(peek_at<std::uint16_t>(at + 2 * i)) / 65535.0f;
      case Component::kByteNorm:
        return std::max(static_cast<float>(peek_at<std::int8_t>(at + i)) / 127.0f, -1.0f);
      case Component::kUnsignedByteNorm:
        return static_cast<float>(peek_at<std::uint8_t>(at + i)) / 255.0f;
      case Component::kTenBits: {
        const auto word = peek_at<std::uint32_t>(at);
        if (c == 3) return static_cast<float>(static_cast<std::int32_t>(word) >> 30);
        const auto high = static_cast<std::int32_t>(word << (22 - 10 * c));
        return std::max(static_cast<float>(high >> 22) / 511.0f, -1.0f);
      }
      case Component::kArgb:
      case Component::kAbgr: {
        const bool red_first = component == Component::kArgb;
        const int shift = c == 3 ? 24 : 8 * (red_first ? 2 - c : c);
        return static_cast<float>(peek_at<std::uint32_t>(at) >> shift & 0xffu) / 255.0f;
      }
    }
    return 0.0f;
  }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
  std::size_t at_ = 0;
  bool swap_ = false;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name, LoadReport& report)
      : bytes_(bytes, name), report_(report) {}

  MeshFile read() {
    header();
    bool has_mesh = false;
    while (bytes_.left() > 0) {
      const Head head = next_chunk();
      if (head.id == kMesh) {
        has_mesh = true;
        mesh();
      } else {
        leave_out(head);
      }
    }
    if (!has_mesh) fail(bytes_.place(bytes_.at()), "the file ends before its mesh");
    check();
    return std::move(mesh_);
  }

 private:
  struct Head {
    std::uint16_t id;
    std::size_t begin;
    std::size_t end;
  };

  struct Element {
    std::size_t at;  // in the file
    std::uint16_t source;
    std::uint16_t type;
    std::uint16_t semantic;
    std::uint16_t offset;
    std::uint16_t set;
  };

  struct Buffer {
    std::size_t begin;
    std::size_t stride;
  };

  /// An element in its buffer.
  struct Stream {
    const Element* element;
    Format format;
    std::size_t begin;
    std::size_t stride;
  };

  struct Indices {
    std::size_t begin;
    std::size_t size_each;
  };

  void header() {
    bytes_.require(2, "a mesh");
    bytes_.set_order(std::endian::little);
    const bool is_little = bytes_.peek_at<std::uint16_t>(0) == kHeader;
    if (!is_little) bytes_.set_order(std::endian::big);
    if (bytes_.read<std::uint16_t>("a mesh") != kHeader) {
      fail(bytes_.place(0), "is no Ogre mesh");
    }
    const std::string version = bytes_.read_string("the version");
    for (std::string_view known : kVersions) {
      if (version != fmt::format("[MeshSerializer_v{}]", known)) continue;
      report_.format = fmt::format("Ogre mesh {}, {}-endian", known, is_little ? "little" : "big");
      return;
    }
    fail(bytes_.place(2), "version '{}' is not read; {} are", version.substr(0, 64),
         fmt::join(kVersions, ", "));
  }

  Head next_chunk() {
    const std::size_t begin = bytes_.at();
    bytes_.require(kChunkHead, "a chunk");
    const auto id = bytes_.read<std::uint16_t>("a chunk");
    const auto length = bytes_.read<std::uint32_t>("a chunk");
    if (length < kChunkHead) {
      fail(bytes_.place(begin), "chunk {:#06x} has a length of {} bytes", id, length);
    }
    bytes_.require(length - kChunkHead, "the chunk");
    return {id, begin, begin + length};
  }

  /// As Ogre does, parts are told by their ids alone: what old exporters wrote as the length of a
  /// chunk with parts is not always right.
  bool next_is(std::initializer_list<Chunk> ids) const {
    if (bytes_.left() < kChunkHead) return false;
    const auto id = bytes_.peek_at<std::uint16_t>(bytes_.at());
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  }

  void leave_out(const Head& head) {
    if (std::find(kLeftOut.begin(), kLeftOut.end(), head.id) == kLeftOut.end()) {
      ++report_.unknown[fmt::format("mesh: chunk {:#06x}", head.id)];
    }
    bytes_.go_to(head.end);
  }

  void mesh() {
    bytes_.read_bool("the mesh");
    while (bytes_.left() > 0) {
      const Head head = next_chunk();
      switch (head.id) {
        case kGeometry:
          mesh_.shared = geometry();
          break;
        case kSubmesh:
          submesh(head);
          break;
        case kNameTable:
          names();
          break;
        default:
          leave_out(head);
      }
    }
  }

  void submesh(const Head& head) {
    Submesh result;
    result.material = bytes_.read_string("the material's name");
    const bool is_shared = bytes_.read_bool("the submesh");
    const auto count = bytes_.read<std::uint32_t>("the submesh");
    const std::size_t size_each = bytes_.read_bool("the submesh") ? 4 : 2;
    bytes_.require(std::uint64_t{count} * size_each, "the list of indices");
    indices_.push_back({bytes_.at(), size_each});
    result.indices.resize(count);
    for (std::uint32_t& index : result.indices) {
      index = size_each == 4 ? bytes_.read<std::uint32_t>("an index")
                             : bytes_.read<std::uint16_t>("an index");
    }
    // Geometry that follows a submesh of shared vertices is the mesh's.
    while (next_is({kOperation, kSubmeshBones, kTextureAlias}) ||
           (!is_shared && next_is({kGeometry}))) {
      const Head part = next_chunk();
      if (part.id == kGeometry) {
        result.own = geometry();
      } else if (part.id == kOperation) {
        const auto operation = bytes_.read<std::uint16_t>("the operation");
        if (!is_operation(operation)) {
          fail(bytes_.place(part.begin), "operation {} is unknown", operation);
        }
        result.operation = static_cast<Operation>(operation);
        bytes_.go_to(part.end);
      } else if (part.id == kTextureAlias) {
        const std::string alias = bytes_.read_string("the texture alias");
        result.textures[alias] = bytes_.read_string("the texture's name");
      } else {
        bytes_.go_to(part.end);
      }
    }
    if (!is_shared && !result.own) {
      findings_.add(bytes_.place(head.begin), "the submesh has no geometry");
      result.own.emplace();
    }
    mesh_.submeshes.push_back(std::move(result));
  }

  Geometry geometry() {
    const std::size_t begin = bytes_.at();
    const std::size_t vertices = bytes_.read<std::uint32_t>("the geometry");
    std::vector<Element> elements;
    std::map<std::uint16_t, Buffer> buffers;
    while (next_is({kDeclaration, kVertexBuffer})) {
      if (next_chunk().id == kVertexBuffer) {
        vertex_buffer(vertices, buffers);
        continue;
      }
      while (next_is({kElement})) elements.push_back(element());
    }

    Geometry result;
    const auto positions = find_stream(elements, buffers, kPosition);
    if (!positions && vertices > 0) {
      fail(bytes_.place(begin), "{} vertices without positions", vertices);
    }
    if (!positions) return result;
    read_into(result.positions, *positions, vertices);
    const auto bad = std::find_if_not(result.positions.begin(), result.positions.end(),
                                      [](const Vec3& p) { return is_finite(p); });
    if (bad != result.positions.end()) {
      const auto i = static_cast<std::size_t>(bad - result.positions.begin());
      findings_.add(bytes_.place(positions->begin + i * positions->stride),
                    "vertex {} is not at a finite place", i);
    }
    if (const auto s = find_stream(elements, buffers, kNormal)) {
      read_into(result.normals, *s, vertices);
    }
    if (const auto s = find_stream(elements, buffers, kTexcoord)) {
      read_into(result.texcoords, *s, vertices);
    }
    if (const auto s = find_stream(elements, buffers, kDiffuse)) {
      read_into(result.colours, *s, vertices);
    }
    return result;
  }

  Element element() {
    const Head head = next_chunk();
    Element e{};
    e.at = head.begin;
    for (std::uint16_t* value : {&e.source, &e.type, &e.semantic, &e.offset, &e.set}) {
      *value = bytes_.read<std::uint16_t>("the vertex element");
    }
    bytes_.go_to(std::max(head.end, bytes_.at()));
    return e;
  }

  void vertex_buffer(std::size_t vertices, std::map<std::uint16_t, Buffer>& buffers) {
    const auto source = bytes_.read<std::uint16_t>("the vertex buffer");
    const std::size_t stride = bytes_.read<std::uint16_t>("the vertex buffer");
    const Head data = next_chunk();
    if (data.id != kVertexData) {
      fail(bytes_.place(data.begin), "chunk {:#06x} where vertices are expected", data.id);
    }
    // Neither factor exceeds 32 bits, so the product cannot overflow.
    const std::size_t size = vertices * stride;
    if (data.end - bytes_.at() != size) {
      fail(bytes_.place(data.begin), "the buffer has {} bytes where {} vertices of {} need {}",
           data.end - bytes_.at(), vertices, stride, size);
    }
    buffers[source] = {bytes_.at(), stride};
    bytes_.go_to(data.end);
  }

  /// The first set of what has that meaning; none if there is none that can be read.
  std::optional<Stream> find_stream(const std::vector<Element>& elements,
                                    const std::map<std::uint16_t, Buffer>& buffers,
                                    Semantic semantic) {
    const Element* found = nullptr;
    for (const Element& e : elements) {
      if (e.semantic == semantic && (!found || e.set < found->set)) found = &e;
    }
    if (!found) return std::nullopt;
    const auto format = format_of(found->type);
    const int least = semantic == kTexcoord ? 1 : 3;
    if (!format || format->count < least ||
        (is_packed_colour(format->component) && semantic != kDiffuse)) {
      if (semantic == kPosition) {
        fail(bytes_.place(found->at), "positions of vertex element type {} cannot be read",
             found->type);
      }
      ++report_.unknown[fmt::format("mesh: vertex element type {}", found->type)];
      return std::nullopt;
    }
    const auto buffer = buffers.find(found->source);
    if (buffer == buffers.end()) {
      fail(bytes_.place(found->at), "the vertex element lies in buffer {}, which is not there",
           found->source);
    }
    const Buffer& b = buffer->second;
    if (found->offset + size_of(*format) > b.stride) {
      fail(bytes_.place(found->at), "the vertex element ends at byte {} of a vertex of {}",
           found->offset + size_of(*format), b.stride);
    }
    return Stream{found, *format, b.begin + found->offset, b.stride};
  }

  template <int N>
  void read_into(std::vector<glm::vec<N, float>>& values, const Stream& stream,
                 std::size_t vertices) {
    const int count = std::min(N, stream.format.count);
    values.reserve(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      // A colour without alpha is opaque, a texture coordinate without v lies on v = 0.
      glm::vec<N, float> value(N == 4 ? 1.0f : 0.0f);
      for (int c = 0; c < count; ++c) {
        value[c] = bytes_.component(stream.begin + i * stream.stride, stream.format.component, c);
      }
      values.push_back(value);
    }
  }

  void names() {
    while (next_is({kName})) {
      const Head head = next_chunk();
      const auto i = bytes_.read<std::uint16_t>("the submesh's name");
      std::string name = bytes_.read_string("the submesh's name");
      if (i < mesh_.submeshes.size()) {
        mesh_.submeshes[i].name = std::move(name);
      } else {
        findings_.add(bytes_.place(head.begin), "names submesh {} of {}", i,
                      mesh_.submeshes.size());
      }
    }
  }

  /// What can be known only when all is read: shared geometry may follow what uses it.
  void check() {
    for (std::size_t s = 0; s < mesh_.submeshes.size(); ++s) {
      const Submesh& submesh = mesh_.submeshes[s];
      if (!has_triangles(submesh.operation)) continue;
      const Indices& indices = indices_[s];
      if (!submesh.own && !mesh_.shared) {
        findings_.add(bytes_.place(indices.begin),
                      "submesh {} uses shared vertices; there are none", s);
        continue;
      }
      const std::size_t vertices = (submesh.own ? *submesh.own : *mesh_.shared).positions.size();
      const auto bad = std::find_if(submesh.indices.begin(), submesh.indices.end(),
                                    [&](std::uint32_t index) { return index >= vertices; });
      if (bad != submesh.indices.end()) {
        const auto i = static_cast<std::size_t>(bad - submesh.indices.begin());
        findings_.add(bytes_.place(indices.begin + i * indices.size_each),
                      "submesh {} uses vertex {} of {}", s, *bad, vertices);
      }
    }
    findings_.throw_if_any();
  }

  Bytes bytes_;
  LoadReport& report_;
  MeshFile mesh_;
  std::vector<Indices> indices_;  // of each submesh, in the file
  Findings findings_;
};

}  // namespace

MeshFile parse_binary(std::span<const std::byte> bytes, const std::string& name,
                      LoadReport& report) {
  return Reader(bytes, name, report).read();
}

}  // namespace ogre

Loaded load_ogre_binary(const std::filesystem::path& path, const LoadOptions& options) {
  LoadReport report;
  const std::vector<std::byte> bytes = read_file(path);
  const ogre::MeshFile mesh = ogre::parse_binary(bytes, path.string(), report);
  return ogre::load_mesh(mesh, std::move(report), path, options);
}

}  // namespace lantern
