// SPDX-License-Identifier: MIT
// Ways to count the shadow volumes between the eye and what it sees.
#pragma once

namespace lantern {

enum class VolumeMethod {
  kExact,  // z-pass with depth clamp, counting on from the count of the eye
  kZFail,  // from behind, with caps at both ends [Everitt & Kilgard 2002]: exact too, and slower
  kZPass,  // from 0 at the eye [Crow 1977; Heidmann 1991]: wrong with the eye inside a volume
};

}  // namespace lantern
