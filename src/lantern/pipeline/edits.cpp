// SPDX-License-Identifier: MIT
#include "lantern/pipeline/edits.h"

#include "lantern/core/error.h"
#include "lantern/core/file.h"
#include "lantern/image/read.h"

#include <fmt/ranges.h>

#include <charconv>
#include <stdexcept>

namespace lantern {

bool matches(std::string_view pattern, std::string_view name) {
  // The last star seen is where a mismatch goes back to; earlier ones need not be reconsidered.
  constexpr std::size_t kNone = std::string_view::npos;
  std::size_t p = 0, n = 0, star = kNone, retry = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      retry = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != kNone) {
      p = star + 1;
      n = ++retry;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<float> parse_numbers(std::string_view text) {
  std::vector<float> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    float value = 0.0f;
    const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (code != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("'{}' is not a number", part));
    }
    numbers.push_back(value);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

Rgb parse_rgb(std::string_view text) {
  const std::vector<float> v = parse_numbers(text);
  if (v.size() != 3) throw std::invalid_argument(fmt::format("'{}' is not R,G,B", text));
  const Rgb rgb(v[0], v[1], v[2]);
  if (glm::any(glm::lessThan(rgb, Rgb(0.0f)))) {
    throw std::invalid_argument(fmt::format("'{}' is negative", text));
  }
  return rgb;
}

EmitterEdit parse_emitter(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw std::invalid_argument(fmt::format("'{}' is not PATTERN=R,G,B", text));
  }
  return {std::string(text.substr(0, equals)), parse_rgb(text.substr(equals + 1))};
}

void apply(const EmitterEdit& edit, Scene& scene) {
  bool found = false;
  for (Material& material : scene.materials) {
    if (!matches(edit.pattern, material.name)) continue;
    material.emission = edit.radiance;
    material.emission_texture.reset();
    found = true;
  }
  if (found) return;
  constexpr std::size_t kNamed = 8;
  std::vector<std::string_view> names;
  for (const Material& material : scene.materials) {
    if (names.size() < kNamed) names.push_back(material.name);
  }
  throw Error(fmt::format("--emitter: no material matches '{}'; there are {}{}", edit.pattern,
                          fmt::join(names, ", "), scene.materials.size() > kNamed ? ", ..." : ""));
}

SkyEdit parse_sky(const std::string& rgb_or_file) {
  try {
    return {parse_rgb(rgb_or_file), {}};
  } catch (const std::invalid_argument& e) {
    if (rgb_or_file.find_first_not_of("0123456789.,+-eE") == std::string::npos) {
      throw std::invalid_argument(fmt::format("--sky: {}", e.what()));
    }
    return {Rgb(1.0f), rgb_or_file};
  }
}

void set_sky(const SkyEdit& edit, Scene& scene) {
  Sky sky;
  sky.radiance = edit.radiance;
  if (!edit.file.empty()) {
    Raster raster = decode_raster(read_file(edit.file), edit.file);
    for (float& value : raster.linear) {
      if (!(value >= 0.0f) || !std::isfinite(value)) value = 0.0f;
    }
    Texture texture;
    texture.name = edit.file;
    texture.width = raster.width;
    texture.height = raster.height;
    texture.srgb8 = std::move(raster.srgb8);
    texture.linear = std::move(raster.linear);
    texture.wrap_v = Wrap::kClamp;
    sky.texture = to_id<TextureId>(scene.textures.size());
    scene.textures.push_back(std::move(texture));
  }
  scene.sky = sky;
}

}  // namespace lantern
