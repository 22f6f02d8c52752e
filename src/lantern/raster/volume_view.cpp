// SPDX-License-Identifier: MIT
#include "lantern/raster/volume_view.h"

#include <cmath>

namespace lantern {

VolumeView::VolumeView(const GBuffer& g_buffer)
    : sides_(gl::Format::kRgba8, g_buffer.depth.width(), g_buffer.depth.height()),
      framebuffer_({&sides_}, &g_buffer.depth),
      sum_(static_cast<std::size_t>(sides_.width()) * static_cast<std::size_t>(sides_.height()),
           Vec4(0.0f)) {}

void VolumeView::add(StencilShadows& shadows, const LightPoint& light, const View& view) {
  shadows.draw_sides(light, view, framebuffer_);
  const std::vector<std::uint8_t> sides = framebuffer_.read<std::uint8_t>();
  constexpr Rgb kFront(1.0f, 0.35f, 0.05f), kBack(0.1f, 0.4f, 1.0f);
  constexpr float kClear = 0.65f;  // what one side lets through
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const auto fronts = static_cast<float>(sides[4 * i]);
    const auto backs = static_cast<float>(sides[4 * i + 1]);
    if (fronts + backs == 0.0f) continue;
    const float cover = 1.0f - std::pow(kClear, fronts + backs);
    const Rgb colour = (fronts * kFront + backs * kBack) / (fronts + backs);
    sum_[i] += Vec4(cover * colour, cover);
  }
  ++samples_;
}

void VolumeView::blend_over(Image& image) const {
  float mean = 0.0f;
  for (const Rgb& pixel : image.pixels) mean += luminance(pixel);
  // Shadows keep the mean low.
  constexpr float kBrighter = 2.5f;
  mean *= kBrighter / static_cast<float>(image.pixels.size());
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const Vec4 over = sum_[i] / static_cast<float>(samples_);
    image.pixels[i] = (1.0f - over.a) * image.pixels[i] + mean * Rgb(over);
  }
}

}  // namespace lantern
