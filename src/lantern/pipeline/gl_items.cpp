// SPDX-License-Identifier: MIT
#include "lantern/pipeline/gl_items.h"

#include "lantern/core/error.h"
#include "lantern/gl/context.h"
#include "lantern/radiosity_gl/item_painter.h"
#include "lantern/scene/surface.h"

namespace lantern {
namespace {

class PainterWithContext : public HemicubePainter {
 public:
  explicit PainterWithContext(const RenderJob& job)
      : context_({.api = {}, .device = job.options.gl_device}),
        painter_(job.world, job.options.radiosity.hemicube.resolution) {}

  void draw(const Hemicube& cube, const HemicubeView& view, std::span<Hit> hits) override {
    painter_.draw(cube, view, hits);
  }

 private:
  gl::Context context_;
  ItemPainter painter_;
};

}  // namespace

std::unique_ptr<HemicubePainter> make_gl_painter(const RenderJob& job) {
  for (const Material& material : job.scene.materials) {
    if (!has_holes(material)) continue;
    throw Error(fmt::format(
        "material '{}' has holes, which item buffers drawn by GL do not know; take --backend cpu",
        material.name));
  }
  return std::make_unique<PainterWithContext>(job);
}

}  // namespace lantern
