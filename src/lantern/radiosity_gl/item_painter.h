// SPDX-License-Identifier: MIT
// A hemicube's item buffer, drawn by GL, for what stands on item buffers drawn with rays: it
// differs from these in pixels whose middle an edge passes to the rounding of float. Surfaces with
// holes are drawn as if whole. Needs a current GL context.
#pragma once

#include "lantern/radiosity/hemicube.h"
#include "lantern/radiosity_gl/item_buffer.h"

#include <cstdint>
#include <vector>

namespace lantern {

class ItemPainter : public HemicubePainter {
 public:
  /// For hemicubes of this resolution; keeps a reference to the world.
  ItemPainter(const World& world, int resolution);

  void draw(const Hemicube& cube, const HemicubeView& view, std::span<Hit> hits) override;

 private:
  const World& world_;
  ItemBuffer buffer_;
  gl::Framebuffer items_;
  std::vector<std::uint32_t> texel_of_pixel_;
};

}  // namespace lantern
