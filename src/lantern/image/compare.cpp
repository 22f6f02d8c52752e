// SPDX-License-Identifier: MIT
#include "lantern/image/compare.h"
