// SPDX-License-Identifier: MIT
// Small scene files made by the tests, and the one line that a broken one ends in.
#pragma once

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/load/load.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lantern::test {

using Json = nlohmann::json;

/// PNG, 2x2 RGBA: red, green; blue of alpha 128, white.
inline constexpr std::string_view kPng64 =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAFElEQVR42mP4z8DwHwyBdMN/"
    "IAAAR00JeHmo6E4AAAAASUVO"
    "RK5CYII=";

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63] : '=';
    }
  }
  return text;
}

inline std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return bytes;
}

template <typename T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

/// glTF of one triangle (0,0,0) (1,0,0) (0,1,0) on node 0, its buffer in a data: URI. Accessor 0
/// has the positions, 1 the indices.
class Gltf {
 public:
  Json json = Json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "bufferViews": [], "accessors": []})");

  Gltf() {
    add("VEC3", raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
    add("SCALAR", raw<std::uint16_t>({0, 1, 2}), 5123);
  }

  /// Adds a bufferView and an accessor of it; returns the accessor's index.
  std::size_t add(const std::string& type, const std::string& bytes, int component_type = 5126) {
    const std::size_t size = component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4;
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"count", bytes.size() / size / components},
                                 {"type", type}});
    buffer_ += bytes;
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    return json["accessors"].size() - 1;
  }

  Json& primitive() { return json["meshes"][0]["primitives"][0]; }

  std::string text() const {
    Json copy = json;
    copy["buffers"] = {{{"byteLength", buffer_.size()},
                        {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}};
    return copy.dump(1);
  }

  std::string glb() const {
    Json copy = json;
    copy["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string chunk = copy.dump();
    chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t n) { return raw({static_cast<std::uint32_t>(n)}); };
    return "glTF" + word(2) + word(12 + 8 + chunk.size() + 8 + buffer_.size()) +
           word(chunk.size()) + "JSON" + chunk + word(buffer_.size()) + std::string("BIN\0", 4) +
           buffer_;
  }

 private:
  std::string buffer_;
};

class LoadTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    write_file(folder / name, text);
    return folder / name;
  }
  Loaded load(const std::string& name, std::string_view text,
              const LoadOptions& options = {}) const {
    return load_scene(write(name, text), options);
  }
  /// The message of the Error that loading ends in, "" if it does not; one line in any case.
  static std::string error_of(const std::filesystem::path& path) {
    try {
      load_scene(path);
      return "";
    } catch (const Error& e) {
      const std::string message = e.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
  }
  std::string error_of(const std::string& name, std::string_view text) const {
    return error_of(write(name, text));
  }
  /// Loading every 64th beginning of `text` ends in a scene or an Error that names the file.
  void expect_survives_truncation(const std::string& name, std::string_view text) const {
    for (std::size_t size = 0; size < text.size(); size += 64) {
      const std::string message = error_of(name, text.substr(0, size));
      EXPECT_TRUE(message.empty() || message.find(name) != std::string::npos) << message;
    }
  }

  TemporaryFolder folder;
};

}  // namespace lantern::test
