// SPDX-License-Identifier: MIT
// The upper half of a cube about a point of a surface, cut into pixels: the form factor from the
// point to what a pixel sees is the pixel's delta form factor, and its item buffer tells what that
// is. Drawn with rays, a packet of pixels at a time. [Cohen & Greenberg 1985, The Hemi-Cube]
#pragma once

#include "lantern/core/math.h"
#include "lantern/trace/tracer.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lantern {

/// Where a hemicube stands: a hair off the surface, turned about its normal.
struct HemicubeView {
  Vec3 origin;
  Frame frame;
  Vec2 shift{0.0f};  // of what a pixel looks at from its centre, in pixels

  /// `normal` is unit length, `angle` in radians, `scale` the scene's largest coordinate.
  HemicubeView(const Vec3& position, const Vec3& normal, float angle, float scale);
};

class Hemicube {
 public:
  /// Pixels along an edge of the top face: a multiple of kResolutionStep, so that packets are
  /// squares of 4x4 pixels; the sides are half as high. Throws Error for any other.
  explicit Hemicube(int resolution);
  static constexpr int kResolutionStep = 8;

  int resolution() const { return resolution_; }
  std::size_t size() const { return delta_.size(); }  // 3 resolution²
  std::size_t packets() const { return delta_.size() / kPacket; }

  /// Of each pixel, packet by packet; their sum is 1.
  std::span<const double> delta() const { return delta_; }
  /// What the sum was before it was made 1, less 1: the error of one sample a pixel, O(1/size()).
  double discretisation() const { return discretisation_; }
  /// Through the centre of the pixel, about +z, not unit length.
  Vec3 direction(std::size_t pixel) const { return {x_[pixel], y_[pixel], z_[pixel]}; }
  /// As the view turns and shifts it, in the world.
  Vec3 direction(const HemicubeView& view, std::size_t pixel) const;

  /// What the sixteen pixels of a packet see.
  void draw(const Tracer& tracer, const HemicubeView& view, std::size_t packet, Hit* hits) const;

 private:
  int resolution_;
  float step_;  // a pixel's edge
  double discretisation_ = 0.0;
  std::vector<float> x_, y_, z_;
  std::vector<double> delta_;
};

/// Draws item buffers otherwise than with rays.
class HemicubePainter {
 public:
  virtual ~HemicubePainter() = default;
  /// What each pixel of the hemicube sees, in its order; distances say just whether it is anything.
  virtual void draw(const Hemicube& cube, const HemicubeView& view, std::span<Hit> hits) = 0;
};

}  // namespace lantern
