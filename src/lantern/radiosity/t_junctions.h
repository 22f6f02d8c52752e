// SPDX-License-Identifier: MIT
// A mesh whose edges meet vertices of other faces between their ends -> one where they do not:
// those faces are cut from such a vertex to the corner opposite. No vertex is added or moved.
#pragma once

#include "lantern/radiosity/patch_mesh.h"

namespace lantern {

/// Vertices no farther than `tolerance`, in metres, from the inside of an edge are on it. Only
/// edges that one face has alone are looked at: where more faces meet in an edge they already share
/// it.
void close_t_junctions(PatchMesh& mesh, double tolerance);

}  // namespace lantern
