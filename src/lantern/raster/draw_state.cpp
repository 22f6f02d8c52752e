// SPDX-License-Identifier: MIT
#include "lantern/raster/draw_state.h"

#include <epoxy/gl.h>

namespace lantern {
namespace {

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

void clip_control(bool near_is_1) {
  const GLenum depth = near_is_1 ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE;
  if (epoxy_is_desktop_gl()) {
    if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control")) {
      glClipControl(GL_LOWER_LEFT, depth);
    }
  } else if (epoxy_has_gl_extension("GL_EXT_clip_control")) {
    glClipControlEXT(GL_LOWER_LEFT, depth);
  }
}

}  // namespace

void apply(const DrawState& state, const View& view) {
  clip_control(view.near_is_1);
  enable(GL_DEPTH_TEST, state.depth != DepthUse::kNone);
  if (state.depth == DepthUse::kReplace) {
    glDepthFunc(GL_ALWAYS);
  } else if (state.depth == DepthUse::kFillGaps) {
    glDepthFunc(view.near_is_1 ? GL_GEQUAL : GL_LEQUAL);
  } else {
    glDepthFunc(view.near_is_1 ? GL_GREATER : GL_LESS);
  }
  const bool writes_depth = state.depth == DepthUse::kDraw || state.depth == DepthUse::kReplace;
  glDepthMask(writes_depth ? GL_TRUE : GL_FALSE);
  const GLboolean colour = state.colour ? GL_TRUE : GL_FALSE;
  glColorMask(colour, colour, colour, colour);
  enable(GL_BLEND, state.add);
  glBlendFunc(GL_ONE, GL_ONE);
  if (state.depth_clamp) {
    glEnable(GL_DEPTH_CLAMP);
  } else if (epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_depth_clamp")) {
    glDisable(GL_DEPTH_CLAMP);
  }
  glFrontFace(state.swap_sides ? GL_CCW : GL_CW);
  enable(GL_CULL_FACE, state.sides != SeenSide::kBoth);
  glCullFace(state.sides == SeenSide::kFront ? GL_BACK : GL_FRONT);
  enable(GL_STENCIL_TEST, state.stencil != StencilUse::kNone);
  constexpr GLuint kAllBits = 0xff;
  switch (state.stencil) {
    case StencilUse::kNone:
      break;
    case StencilUse::kCountPassing:
      glStencilFunc(GL_ALWAYS, 0, kAllBits);
      glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
      glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
      break;
    case StencilUse::kCountHidden:
      glStencilFunc(GL_ALWAYS, 0, kAllBits);
      glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
      glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
      break;
    case StencilUse::kTake:
      glStencilFunc(GL_EQUAL, state.reference, kAllBits);
      glStencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
      break;
    case StencilUse::kMark:
      glStencilFunc(GL_ALWAYS, state.reference, kAllBits);
      glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
      break;
    case StencilUse::kMatch:
      glStencilFunc(GL_EQUAL, state.reference, kAllBits);
      glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
      break;
  }
}

void set_viewport(const View& view) {
  glViewport(view.origin.x, view.origin.y, view.size.x, view.size.y);
}

void reset_draw_state() {
  clip_control(false);
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
  if (epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_depth_clamp")) {
    glDisable(GL_DEPTH_CLAMP);
  }
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  glDisable(GL_STENCIL_TEST);
}

float far_depth(const View& view) { return view.near_is_1 ? 0.0f : 1.0f; }

float near_z(const View& view) { return view.near_is_1 ? 1.0f : -1.0f; }

}  // namespace lantern
