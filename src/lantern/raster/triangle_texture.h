// SPDX-License-Identifier: MIT
// The triangles of a World as textures that shaders meet rays with: see shaders/triangles.glsl.
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/raster/convex_patches.h"
#include "lantern/scene/world.h"

namespace lantern {

struct TriangleTextures {
  /// Throws Error for more triangles than a texture holds.
  TriangleTextures(const Scene& scene, const World& world);

  ConvexPatches patches;
  /// Of each triangle, patch by patch, three texels, row by row: a corner, and the number of a
  /// triangle without holes beyond the edge from it to the next and 1, or 0; of veils (see
  /// even_coverage()) in place of that the share of rays that they stop.
  gl::Texture corners;
  /// Of each triangle of the world a texel: its number and that of the first of its patch in the
  /// patches' order, how many these are, PatchSides.
  gl::Texture owners;

 private:
  TriangleTextures(const Scene& scene, const World& world,
                   std::span<const std::array<std::uint32_t, 3>> neighbours);
};

}  // namespace lantern
