// SPDX-License-Identifier: MIT
#include "lantern/image/read.h"
