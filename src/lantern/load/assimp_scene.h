// SPDX-License-Identifier: MIT
// OBJ, COLLADA, PLY, STL, FBX and what else assimp 5 reads: node transforms, instances, cameras,
// lights, diffuse and emissive colour and texture. Colours are taken as linear, light colours as
// W/sr and W/m²; attenuation laws other than 1/d² are not kept. Errors: Error with assimp's words.
#pragma once

#include "lantern/load/load.h"

namespace lantern {

/// Points and lines are dropped and counted. MTL without Kd is assimp's 0.6; texture coordinates
/// out of range are dropped. A field of view without an aspect ratio counts as that of a square;
/// assimp 5.2 finds none in COLLADA, whose cameras get the usual one and a warning.
///
/// Files come to assimp through our own reading, which refuses devices and files above 1 GiB. What
/// assimp does with bytes made to harm it, in its less used formats above all, cannot be checked
/// from here: read such formats from strangers in a process that may die.
Loaded load_assimp(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lantern
