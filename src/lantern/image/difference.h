// SPDX-License-Identifier: MIT
// Where two pictures differ, as pictures. Errors: Error as compare() gives.
#pragma once

#include "lantern/image/image.h"

#include <span>

namespace lantern {

/// a - b, channel by channel.
Image difference(const Image& a, const Image& b);

/// The relative difference of luminance, (Y_a - Y_b)/sqrt(Y_b² + 0.01), as a colour: white where
/// there is none, red where `a` is brighter, blue where it is darker, the full colour from `full`
/// on. Linear, in [0, 1]. `full` is positive.
Image paint_difference(const Image& a, const Image& b, float full);

/// Errors in [0, 1], row by row, as a colour that gets brighter with them: black, violet, red,
/// orange, pale yellow. Linear, in [0, 1].
Image paint_errors(std::span<const float> errors, int width, int height);

/// The same as grey, the error itself in each channel.
Image grey_errors(std::span<const float> errors, int width, int height);

}  // namespace lantern
