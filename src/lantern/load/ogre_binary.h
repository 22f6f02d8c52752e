// SPDX-License-Identifier: MIT
// Ogre's binary mesh (.mesh) into a Scene, as ogre_xml.h does it: formats 1.30, 1.40, 1.41, 1.8 and
// 1.100 of either byte order. Memory stays in proportion to the file whatever its counts say.
// Errors: Error with file and byte; other versions are refused by name.
// Source of the format: the chunks listed in OgreMain/src/OgreMeshFileFormat.h of Ogre.
#pragma once

#include "lantern/load/load.h"
#include "lantern/load/ogre_mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace lantern {

namespace ogre {

/// The mesh in `bytes`; `name` is for messages. What is unknown is counted in `report`.
MeshFile parse_binary(std::span<const std::byte> bytes, const std::string& name,
                      LoadReport& report);

}  // namespace ogre

/// Not validated yet (see scene/validate.h).
Loaded load_ogre_binary(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lantern
