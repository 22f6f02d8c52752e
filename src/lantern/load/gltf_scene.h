// SPDX-License-Identifier: MIT
// glTF 2.0 and GLB [Khronos 2021]: meshes, nodes, cameras, materials and their textures, punctual
// lights (candela taken as W/sr, lux as W/m²), emission (taken as W/(m² sr)) and its strength.
// Errors: Error with line and column where the JSON breaks off, else with the object at fault.
#pragma once

#include "lantern/load/load.h"

namespace lantern {

/// Read without assimp: version 5.2 loses the emissive strength, all but one use of a light or
/// camera and which material is which, moves cameras twice, and trusts every number of the file.
///
/// A metal's base colour counts as its reflectance, skins and morph targets stay at rest, points
/// and lines are dropped and counted. Extensions the file requires and that are not read are an
/// Error, others are counted in the report.
Loaded load_gltf(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lantern
