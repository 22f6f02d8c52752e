// SPDX-License-Identifier: MIT
#include "lantern/image/tone.h"
