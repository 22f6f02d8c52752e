// SPDX-License-Identifier: MIT
#include "lantern/sampling/distribution.h"
