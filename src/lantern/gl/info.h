// SPDX-License-Identifier: MIT
// What the current context is and can do, as far as Lantern cares.
#pragma once

#include <string>
#include <vector>

namespace lantern::gl {

/// Something that newer or desktop GL has and the rest may have by an extension.
struct Feature {
  std::string name;
  std::string by;  // "core", the extension's name, or empty: it is not there
};

struct Limit {
  std::string name;
  int value = 0;
};

struct Info {
  std::string vendor, renderer, version, glsl;  // as GL says them
  bool es = false;
  int major = 0, minor = 0;
  std::vector<Feature> features;
  std::vector<Limit> limits;

  bool has(const std::string& feature) const;
  int limit(const std::string& name) const;
};

/// Names of features and limits.
inline constexpr const char* kFloatTargets = "float targets";      // draw into 32-bit floats
inline constexpr const char* kFloatBlending = "float blending";    // and blend there
inline constexpr const char* kFloatFiltering = "float filtering";  // bilinear 32-bit floats
inline constexpr const char* kDepthClamp = "depth clamp";
inline constexpr const char* kClipControl = "clip control";  // depth in [0, 1] before its write
inline constexpr const char* kTimers = "timers";
inline constexpr const char* kTextureSize = "texture size";

Info query_info();

}  // namespace lantern::gl
