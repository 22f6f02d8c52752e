// SPDX-License-Identifier: MIT
#include "lantern/image/write.h"
