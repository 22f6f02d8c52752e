// SPDX-License-Identifier: MIT
// LDR-FLIP: how strongly a person sees the difference of two pictures shown in turn at one place.
// In: radiance, brought to [0, 1] by a tone curve. Out: an error in [0, 1] per pixel, and its mean.
// Symmetric in the two pictures. Errors: Error as compare() gives. [Andersson et al. 2020, FLIP: A
// Difference Evaluator for Alternating Images, its pipelines of colour and of features]
#pragma once

#include "lantern/image/image.h"
#include "lantern/image/tone.h"

#include <vector>

namespace lantern {

struct FlipOptions {
  Tone tone;
  // In [1, 1000]. 67: a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m, as in the paper.
  double pixels_per_degree = 67.0;
};

struct Flip {
  double mean = 0.0;
  std::vector<float> error;  // row by row
};

Flip flip(const Image& a, const Image& b, const FlipOptions& options = {});

}  // namespace lantern
