// SPDX-License-Identifier: MIT
// Depth is near / distance: floats keep that with the same relative precision near and far, where the
// fixed function's depth would crowd just below 1.
uniform float near;
flat in uint item;
layout(location = 0) out uint seen;
void main() {
  seen = item;
  gl_FragDepth = near * gl_FragCoord.w;
}
