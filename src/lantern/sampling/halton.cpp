// SPDX-License-Identifier: MIT
#include "lantern/sampling/halton.h"
