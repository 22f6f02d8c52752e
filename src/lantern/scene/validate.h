// SPDX-License-Identifier: MIT
// What every Scene must satisfy before light is made in it. Loaders call this last.
#pragma once

#include "lantern/scene/scene.h"

#include <string>
#include <vector>

namespace lantern {

/// Throws Error with `file` as its place and everything found (the first few) in one line: ids and
/// vertex indices out of range, coordinates that are not finite, optional arrays of the wrong
/// length, textures whose texels do not match their size, cameras that cannot see. Repairs what is
/// harmless and says so in the returned warnings: triangles without area are dropped, reflectances
/// and opacity brought into [0, 1], negative or infinite emission set to zero, normals that are not
/// usable (zero, not finite) replaced by zero, which means "use the triangle's own".
std::vector<std::string> validate(Scene& scene, const std::string& file);

}  // namespace lantern
