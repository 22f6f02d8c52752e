// SPDX-License-Identifier: MIT
// Ogre's DotScene (.scene) into a Scene: meshes, cameras, lights and the sky of a tree of nodes.
// Cameras and lights look along -z of their node. A camera's `fov` is vertical: radians up to pi,
// degrees above, as exporters write both; so are the whole cone angles of a spot's lightRange. A
// light sends colourDiffuse times `power` (or `powerScale`, else 1): W/sr from a point or spot,
// W/m² from a directional one, with the square law in place of lightAttenuation. colourAmbient is
// the sky's radiance. Errors: Error with file and line. Source: the DotScene plugin of Ogre.
#pragma once

#include "lantern/core/error.h"
#include "lantern/load/load.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lantern {

namespace ogre {

struct Entity {
  Place place;
  std::string mesh_file;
  std::string material;  // of all submeshes, or a script's name; empty: the mesh's own
  std::map<std::uint32_t, std::string> submesh_materials;
  Mat4 transform{1.0f};
};

/// Nodes in the order of the file, their transforms multiplied out.
struct DotScene {
  std::vector<Entity> entities;
  std::vector<Camera> cameras;
  std::vector<PunctualLight> lights;
  std::optional<Sky> sky;
};

/// The scene in `text`; `name` is for messages. What is unknown is counted in `report`.
DotScene parse_dotscene(std::string_view text, const std::string& name, LoadReport& report);

}  // namespace ogre

/// Meshes (.mesh or .mesh.xml, each read once), scripts and pictures are sought beside the scene,
/// then in its folders models, meshes, materials and textures. Not validated yet (see
/// scene/validate.h).
Loaded load_dotscene(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lantern
