// SPDX-License-Identifier: MIT
#include "lantern/trace/embree.h"
