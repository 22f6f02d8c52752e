// SPDX-License-Identifier: MIT
#include "lantern/load/load.h"
