// SPDX-License-Identifier: MIT
// What GL is told before something is drawn. What is not said is off.
#pragma once

#include "lantern/raster/bodies.h"
#include "lantern/raster/view.h"

namespace lantern {

enum class DepthUse {
  kNone,
  kDraw,
  kTest,      // pass what is nearer, write nothing
  kFillGaps,  // pass what is not further, write nothing
  kReplace    // pass and write all
};
enum class StencilUse {
  kNone,
  kCountPassing,  // +1 for fronts that are nearer, -1 for backs
  kCountHidden,   // +1 for backs that are not nearer, -1 for fronts
  kTake,          // pass where it is `reference`, and zero it everywhere
  kMark,          // make it `reference`
  kMatch          // pass where it is `reference`
};

struct DrawState {
  DepthUse depth = DepthUse::kNone;
  StencilUse stencil = StencilUse::kNone;
  int reference = 0;
  bool swap_sides = false;           // fronts are backs
  SeenSide sides = SeenSide::kBoth;  // what is not this side of its triangle is left out
  bool colour = true;
  bool add = false;
  bool depth_clamp = false;
};

/// Until the next call. `view` decides which depth is near.
void apply(const DrawState& state, const View& view);

/// Draws go to the view's part of the framebuffer that is bound, all of which they would else.
void set_viewport(const View& view);

/// GL as it starts, and as others expect it.
void reset_draw_state();

/// Depth of what is infinitely far.
float far_depth(const View& view);
/// The z of what is as near as can be drawn, w being 1.
float near_z(const View& view);

}  // namespace lantern
