// SPDX-License-Identifier: MIT
#include "lantern/sampling/warp.h"
