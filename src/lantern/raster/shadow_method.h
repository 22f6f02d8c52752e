// SPDX-License-Identifier: MIT
// How GL finds out which lights a point sees. No GL in it: options name it too.
#pragma once

namespace lantern {

enum class ShadowMethod {
  kVolumes,  // exact [Crow 1977]; see volume_method.h
  kMaps,     // cheaper where there are many triangles [Lecocq et al. 2014]
  kCheaper,  // that of the two that is likely to take less time
};

}  // namespace lantern
