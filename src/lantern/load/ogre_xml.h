// SPDX-License-Identifier: MIT
// Ogre's XML mesh (.mesh.xml) into a Scene: a mesh and an instance per submesh; materials come from
// scripts, see ogre_material.h. Vertex colours are linear. Errors: Error with file and line.
// Source of the format: ogrexmlconverter's schema, Tools/XMLConverter/docs/ogremeshxml.dtd of Ogre.
#pragma once

#include "lantern/load/load.h"
#include "lantern/load/ogre_mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace lantern {

namespace ogre {

/// The mesh in `text`; `name` is for messages. What is unknown is counted in `report`.
MeshFile parse_xml(std::string_view text, const std::string& name, LoadReport& report);

}  // namespace ogre

/// Not validated yet (see scene/validate.h).
Loaded load_ogre_xml(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lantern
