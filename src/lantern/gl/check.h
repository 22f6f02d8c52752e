// SPDX-License-Identifier: MIT
// What GL says went wrong, as an Error.
#pragma once

namespace lantern::gl {

/// Throws Error if GL has an error to tell: out of memory, a lost context, or a call that this
/// driver refuses. `doing` says what was tried: "drawing the item buffer".
void check(const char* doing);

}  // namespace lantern::gl
