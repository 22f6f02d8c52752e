// SPDX-License-Identifier: MIT
// What the command line changes in a loaded scene before light is made in it.
#pragma once

#include "lantern/core/math.h"
#include "lantern/scene/scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace lantern {

/// Materials whose name matches emit this radiance.
struct EmitterEdit {
  std::string pattern;  // '*' stands for any characters, '?' for one
  Rgb radiance{0.0f};
};

bool matches(std::string_view pattern, std::string_view name);

/// "PATTERN=R,G,B". Throws std::invalid_argument, which says what is wrong.
EmitterEdit parse_emitter(std::string_view text);

/// "R,G,B", finite and not negative. Throws std::invalid_argument.
Rgb parse_rgb(std::string_view text);

/// Comma-separated finite numbers. Throws std::invalid_argument.
std::vector<float> parse_numbers(std::string_view text);

/// Throws Error if no material of the scene matches.
void apply(const EmitterEdit& edit, Scene& scene);

/// The sky is this radiance, constant or times a lat-long picture's.
struct SkyEdit {
  Rgb radiance{1.0f};
  std::string file;  // empty: constant
};

/// "R,G,B" for a constant sky, anything else is the path of a lat-long picture. Throws
/// std::invalid_argument for what are numbers but not three.
SkyEdit parse_sky(const std::string& rgb_or_file);

/// Reads the picture, if there is one. Throws Error.
void set_sky(const SkyEdit& edit, Scene& scene);

}  // namespace lantern
