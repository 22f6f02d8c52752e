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
/// harmless and says so in the returned warnings: triangles without area (or with more of it than
/// float can square) are dropped, reflectances and opacity brought into [0, 1], emission and texels
/// that are negative or not finite set to zero. Without a word: normals that are not finite become
/// zero, which means "use the triangle's own"; vertex colours that are not finite black; cones of
/// spots ordered within [0, pi].
std::vector<std::string> validate(Scene& scene, const std::string& file);

}  // namespace lantern
