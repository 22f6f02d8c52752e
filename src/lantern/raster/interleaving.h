// SPDX-License-Identifier: MIT
// Each pixel of a tile takes its share of the lights, and neighbours on the same surface lend each
// other theirs. [Keller & Heidrich 2001, Interleaved Sampling; Segovia et al. 2006, Non-interleaved
// Deferred Shading of Interleaved Sample Patterns]
#pragma once

#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/lighting.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lantern {

/// Lights in `shares` sets, each well spread: paths that follow one another are, so every bounce's
/// are cut into runs; which of them a set gets moves on with `turn`. Indices into the lights.
std::vector<std::vector<std::uint32_t>> share_out(const VirtualLights& lights, std::size_t shares,
                                                  std::size_t turn);

/// Pictures of every tile-th pixel, side by side, and what they are filtered into.
class Interleaving {
 public:
  /// Keeps nothing. `tile` x `tile` pixels take all lights together.
  Interleaving(const gl::ShaderFiles& files, int width, int height, int tile, float radius);

  /// The picture of pixels (x, y) + tile * (column, row).
  void take(const Target& irradiance, int x, int y);
  /// The irradiance of all pixels by all lights. `g_buffer` is that of the whole picture.
  const Target& filter(const GBuffer& g_buffer);

 private:
  int tile_;
  float radius_;
  gl::Program add_rows_, filter_;
  gl::Texture shares_;
  Target rows_, irradiance_;
  gl::VertexArray no_vertices_;
};

}  // namespace lantern
