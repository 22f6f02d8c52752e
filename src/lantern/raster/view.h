// SPDX-License-Identifier: MIT
// A camera as GL draws by it: the same ray through each pixel as Eye's, row 0 of the framebuffer
// the top of the picture, nothing too far (infinity has a depth). Clockwise in the framebuffer is
// counter-clockwise in the picture.
#pragma once

#include "lantern/scene/scene.h"

#include <cstdint>
#include <vector>

namespace lantern {

/// Which depths the projection makes. Floats are dense around 0: with the far end there depth is
/// exact to its last bit everywhere. That takes clip control, for which -1 is not the far end.
enum class ClipRange { kFarIs0, kFarIs1 };

struct ViewOptions {
  int width = 512;
  int height = 512;
  Vec2 offset{0.5f};  // where in its pixel each sample lies
  // The framebuffer holds pixel (x, y) + step * (column, row) of the picture.
  int step = 1;
  glm::ivec2 first{0};
  glm::ivec2 origin{0};  // texel of the framebuffer that this picture begins at
  float radius = 1.0f;   // of the scene; closer than a small part of it depth is not told apart
  ClipRange range = ClipRange::kFarIs0;

  int columns() const { return (width + step - 1) / step; }
  int rows() const { return (height + step - 1) / step; }
};

struct View {
  Vec3 eye;
  Mat4 clip;                    // of (position relative to the eye, 1) or (direction, 0)
  bool near_is_1;               // else near is depth 0
  Vec3 corner, step_x, step_y;  // ray of column i, row j: corner + i step_x + j step_y
  glm::ivec2 first;             // pixel of the picture: first + step * (i, j)
  int step;
  glm::ivec2 origin, size;  // of the framebuffer's texels, those that are drawn to
  std::uint32_t seed;       // of random numbers that only what shares its place in the pixel shares
};

View make_view(const Camera& camera, const ViewOptions& options);

/// Planes through the eye with all that is seen before them, of length 1.
std::vector<Vec4> sides_of(const View& view);

}  // namespace lantern
