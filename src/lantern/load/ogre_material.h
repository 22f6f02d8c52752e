// SPDX-License-Identifier: MIT
// Ogre's material scripts into Materials. Of a material counts the first pass that writes colour:
// diffuse (or vertex colours) times the first texture is the reflectance, emissive the radiance,
// likewise times the texture as in Ogre's fixed pipeline. Colours are taken as linear numbers,
// pictures as sRGB. Where no diffuse is given it is 1 under a texture and 0.8 else; ambient light
// does not exist here. Alpha counts where alpha_blend or alpha_rejection ask for it.
// Errors: Error with file and line. Source: the Ogre manual, Material Scripts.
#pragma once

#include "lantern/load/load.h"
#include "lantern/load/textures.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lantern::ogre {

class Materials {
 public:
  /// Fills `scene` and `report`, which must outlive it. Pictures are sought beside the script that
  /// names them, then in `folders`.
  Materials(Scene& scene, LoadReport& report, std::vector<std::filesystem::path> folders);
  ~Materials();

  /// Scripts added later win where they define the same material. `file` is for messages, and its
  /// folder for pictures. Throws if braces, quotes or comments stay open.
  void add_script(std::string_view text, const std::filesystem::path& file);
  void add_file(const std::filesystem::path& file);

  /// All *.material in the folder, sorted by name.
  void add_folder(const std::filesystem::path& folder);

  bool defines(const std::string& name) const;

  /// The material of that name in the scene, made at its first use. `textures` (alias -> picture)
  /// replaces the textures of units that have these aliases. BaseWhite, BaseWhiteNoLighting and ""
  /// are Ogre's own: a reflectance of 0.8, as 1 would never lose light. What no script defines
  /// becomes (0.8, 0.2, 0.8) with a warning.
  MaterialId use(const std::string& name, const std::map<std::string, std::string>& textures = {});

  Scene& scene() { return scene_; }
  LoadReport& report() { return report_; }

 private:
  struct Scripts;
  class Draft;
  using Key = std::pair<std::string, std::map<std::string, std::string>>;

  Scene& scene_;
  LoadReport& report_;
  std::vector<std::filesystem::path> folders_;
  TextureCache textures_;
  std::unique_ptr<Scripts> scripts_;
  std::map<Key, MaterialId> used_;
};

}  // namespace lantern::ogre
