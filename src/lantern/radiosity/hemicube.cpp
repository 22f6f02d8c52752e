// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lantern {
namespace {

constexpr int kTile = 4;  // pixels along an edge of a packet
static_assert(kTile * kTile == kPacket);

Frame turned(const Vec3& normal, float angle) {
  Frame frame(normal);
  const float c = std::cos(angle), s = std::sin(angle);
  const Vec3 tangent = c * frame.tangent + s * frame.bitangent;
  frame.bitangent = c * frame.bitangent - s * frame.tangent;
  frame.tangent = tangent;
  return frame;
}

}  // namespace

HemicubeView::HemicubeView(const Vec3& position, const Vec3& normal, float angle, float scale)
    : origin(off_surface(position, normal, scale)), frame(turned(normal, angle)) {}

Hemicube::Hemicube(int resolution)
    : resolution_(resolution), step_(2.0f / static_cast<float>(resolution)) {
  if (resolution < kResolutionStep || resolution % kResolutionStep != 0) {
    throw Error(fmt::format("a hemicube of {} pixels along its edge; it takes a multiple of {}",
                            resolution, kResolutionStep));
  }
  const double step = 2.0 / resolution;
  const auto coordinate = [&](int i) { return (i + 0.5) * step - 1.0; };
  // [Cohen & Greenberg 1985, section 5]: ΔA / (π (x² + y² + 1)²) on the top face, z ΔA / (π (y² +
  // z² + 1)²) on a side; both are cos θ ΔA / (π r⁴) with r the distance of the pixel.
  const auto add = [&](double x, double y, double z) {
    const double square = x * x + y * y + z * z;
    x_.push_back(static_cast<float>(x));
    y_.push_back(static_cast<float>(y));
    z_.push_back(static_cast<float>(z));
    delta_.push_back(z * step * step / (std::numbers::pi * square * square));
  };
  const auto each_pixel = [&](int rows, const auto& body) {
    for (int y = 0; y < rows; y += kTile) {
      for (int x = 0; x < resolution; x += kTile) {
        for (int i = 0; i < kPacket; ++i) body(coordinate(x + i % kTile), y + i / kTile);
      }
    }
  };
  each_pixel(resolution, [&](double u, int row) { add(u, coordinate(row), 1.0); });
  for (const double sign : {1.0, -1.0}) {
    each_pixel(resolution / 2, [&](double u, int row) { add(sign, u, (row + 0.5) * step); });
    each_pixel(resolution / 2, [&](double u, int row) { add(u, sign, (row + 0.5) * step); });
  }

  double sum = 0.0;
  for (const double d : delta_) sum += d;
  discretisation_ = sum - 1.0;
  for (double& d : delta_) d /= sum;
}

Vec3 Hemicube::direction(const HemicubeView& view, std::size_t pixel) const {
  Vec3 d = direction(pixel);
  const Vec2 shift = step_ * view.shift;
  if (d.z == 1.0f) {
    d += Vec3(shift, 0.0f);
  } else {
    (std::abs(d.x) == 1.0f ? d.y : d.x) += shift.x;
    d.z += shift.y;
  }
  return view.frame.to_world(d);
}

void Hemicube::draw(const Tracer& tracer, const HemicubeView& view, std::size_t packet,
                    Hit* hits) const {
  RayPacket rays;
  LaneMask active;
  const std::size_t first = packet * kPacket;
  for (int i = 0; i < kPacket; ++i) {
    rays.set(i, view.origin, direction(view, first + static_cast<std::size_t>(i)));
    active.lane[i] = -1;
  }
  tracer.closest(active, rays, hits);
}

}  // namespace lantern
