// SPDX-License-Identifier: MIT
// Small Ogre files made by the tests: text from short strings, binary meshes from a writer of the
// chunk format that can also write what Ogre's own tools cannot.
#pragma once

#include "lantern/core/error.h"
#include "lantern/load/load.h"
#include "lantern/load/ogre_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lantern::test {

/// What the Error says that `action` throws; "no error" without one.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

/// Numbers, strings and nested chunks in one byte order.
class ChunkWriter {
 public:
  explicit ChunkWriter(std::endian order = std::endian::little) : order_(order) {}

  template <typename T>
  ChunkWriter& put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (order_ != std::endian::native) std::reverse(raw, raw + sizeof(T));
    text_.append(raw, sizeof(T));
    return *this;
  }
  template <typename T>
  ChunkWriter& put_all(std::initializer_list<T> values) {
    for (T value : values) put(value);
    return *this;
  }
  ChunkWriter& u8(int value) { return put(static_cast<std::uint8_t>(value)); }
  ChunkWriter& u16(int value) { return put(static_cast<std::uint16_t>(value)); }
  ChunkWriter& u32(std::uint32_t value) { return put(value); }
  ChunkWriter& string(std::string_view value) {
    text_.append(value).push_back('\n');
    return *this;
  }
  ChunkWriter& chunk(int id, const std::function<void()>& content) {
    u16(id);
    const std::size_t length_at = text_.size();
    u32(0);
    content();
    const std::string all = std::move(text_);
    text_.clear();
    u32(static_cast<std::uint32_t>(all.size() - length_at + 2));
    text_ = all.substr(0, length_at) + text_ + all.substr(length_at + 4);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::endian order_;
  std::string text_;
};

struct ElementSpec {
  int type;
  int semantic;
  int offset;
  int source = 0;
  int set = 0;
};

/// A binary mesh of one triangle with its own geometry; each part can be replaced.
struct BinaryMesh {
  std::endian order = std::endian::little;
  std::string version = "[MeshSerializer_v1.100]";
  std::vector<ElementSpec> elements{{2, 1, 0}};
  std::uint32_t vertices = 3;
  int stride = 12;
  std::vector<std::uint32_t> indices{0, 1, 2};
  bool wide_indices = false;
  int operation = 4;
  std::function<void(ChunkWriter&)> data = [](ChunkWriter& w) {
    w.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  };
  std::function<void(ChunkWriter&)> in_submesh = [](ChunkWriter&) {};
  std::function<void(ChunkWriter&)> in_mesh = [](ChunkWriter&) {};

  void write_geometry(ChunkWriter& w) const {
    w.chunk(0x5000, [&] {
      w.u32(vertices);
      w.chunk(0x5100, [&] {
        for (const ElementSpec& e : elements) {
          w.chunk(0x5110,
                  [&] { w.u16(e.source).u16(e.type).u16(e.semantic).u16(e.offset).u16(e.set); });
        }
      });
      w.chunk(0x5200, [&] {
        w.u16(0).u16(stride);
        w.chunk(0x5210, [&] { data(w); });
      });
    });
  }

  std::string write() const {
    ChunkWriter w(order);
    w.u16(0x1000).string(version);
    w.chunk(0x3000, [&] {
      w.u8(0);
      w.chunk(0x4000, [&] {
        w.string("stone").u8(0).u32(static_cast<std::uint32_t>(indices.size()));
        w.u8(wide_indices ? 1 : 0);
        for (std::uint32_t i : indices) {
          if (wide_indices) {
            w.u32(i);
          } else {
            w.u16(static_cast<int>(i));
          }
        }
        write_geometry(w);
        w.chunk(0x4010, [&] { w.u16(operation); });
        in_submesh(w);
      });
      in_mesh(w);
    });
    return w.text();
  }
};

/// The Scene of a mesh file in memory, with the scripts in `materials`.
inline Loaded assemble(const ogre::MeshFile& file, std::string_view materials = {}) {
  Loaded loaded;
  ogre::Materials library(loaded.scene, loaded.report, {});
  library.add_script(materials, "test.material");
  for (const auto& mesh : ogre::add_meshes(file, library)) {
    if (mesh) loaded.scene.instances.push_back({*mesh, Mat4(1.0f), std::nullopt});
  }
  return loaded;
}

/// Meshes, materials and instances; colours within `colour_tolerance`, all else exactly.
inline void expect_same(const Scene& a, const Scene& b, float colour_tolerance = 0.0f) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    const Mesh& m = a.meshes[i];
    const Mesh& n = b.meshes[i];
    EXPECT_EQ(m.name, n.name);
    EXPECT_EQ(m.positions, n.positions) << m.name;
    EXPECT_EQ(m.normals, n.normals) << m.name;
    EXPECT_EQ(m.texcoords, n.texcoords) << m.name;
    EXPECT_EQ(m.triangles, n.triangles) << m.name;
    ASSERT_EQ(m.colours.size(), n.colours.size()) << m.name;
    float largest = 0.0f;
    for (std::size_t v = 0; v < m.colours.size(); ++v) {
      for (int c = 0; c < 4; ++c) {
        largest = std::max(largest, std::abs(m.colours[v][c] - n.colours[v][c]));
      }
    }
    EXPECT_LE(largest, colour_tolerance) << m.name;
    EXPECT_EQ(a.materials[index(m.material)].name, b.materials[index(n.material)].name);
  }
  EXPECT_EQ(a.instances.size(), b.instances.size());
}

}  // namespace lantern::test
