// SPDX-License-Identifier: MIT
// A path to a Scene: the format follows from the name. Errors: Error with file and line or byte;
// what is unknown but harmless is counted in the report.
#pragma once

#include "lantern/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lantern {

struct LoadOptions {
  std::vector<std::filesystem::path> material_scripts;  // beside those found next to the scene
  float unit = 1.0f;                                    // metres per unit of the file
};

struct LoadReport {
  std::string format;                  // "Ogre mesh 1.100, little-endian"
  std::vector<std::string> warnings;   // each once, ready to print
  std::map<std::string, int> unknown;  // unknown attribute, element or chunk -> times met

  /// Adds a warning unless the same one is there already.
  void warn(std::string text);
};

struct Loaded {
  Scene scene;
  LoadReport report;
};

/// A scene far from zero, where floats are coarse, is moved near it; Scene::origin tells how far.
/// Ogre `.mesh.xml` (and `.xml` with a <mesh> root), `.mesh`, `.scene`, and whatever assimp reads.
Loaded load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace lantern
